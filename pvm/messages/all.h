// Every message, and what each must have.
//
// Facts hold in any epoch; work of another epoch than the receiver's is refused.  A packet is
//   version u8 | epoch u32 | message*        message = tag u8, fields
// See docs/wire-format.md.  The tasks and their messages are those of Reinhard & Jansen, figures 2 and 3.
//
// To add a message: its struct, its serialize() and its name in the list at the end, all in one of the
// headers below; in the task that receives it, `Accepted` and a handler on(from, message); a row in docs/wire-format.md.
// The compiler and wire_format_test say what is missing.
//
//   isFact     whether it is a fact or work
//   tag        its number on the wire, and its position in AllMessages: the next one that is free
//   serialize  its fields
//
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pvm/messages/cells.h"
#include "pvm/messages/control.h"
#include "pvm/messages/events.h"
#include "pvm/messages/images.h"
#include "pvm/messages/rays.h"

namespace rayshade {

template <class M>
concept Message = Serializable<M> && std::is_default_constructible_v<M> && requires {
  { M::isFact } -> std::convertible_to<bool>;
  { M::tag } -> std::convertible_to<std::uint8_t>;
};

// The messages of several lists, in the order of their tags.
template <class... List>
struct InOrderOfTags;
template <class... M>
struct InOrderOfTags<TypeList<M...>> {
  static constexpr std::size_t withTag(std::size_t tag) { return ((M::tag == tag ? 1 : 0) + ...); }
  static constexpr bool areNumbered() {
    for (std::size_t tag = 0; tag < sizeof...(M); ++tag)
      if (withTag(tag) != 1) return false;
    return true;
  }
  static_assert(
      areNumbered(),
      "the tags of messages (pvm/messages/*.h) are 0, 1, 2 ..., each used once: a new message takes "
      "the number of messages before it");

  static constexpr std::size_t positionOf(std::size_t tag) {
    std::size_t position = 0;
    (void)((M::tag == tag || (++position, false)) || ...);
    return position;
  }
  template <std::size_t... Tag>
  static TypeList<std::tuple_element_t<positionOf(Tag), std::tuple<M...>>...> sorted(
      std::index_sequence<Tag...>);
  using Type = decltype(sorted(std::make_index_sequence<sizeof...(M)>()));
};
template <class... A, class... B, class... Rest>
struct InOrderOfTags<TypeList<A...>, TypeList<B...>, Rest...> : InOrderOfTags<TypeList<A..., B...>, Rest...> {
};

using AllMessages =
    InOrderOfTags<ControlMessages, CellMessages, RayMessages, ImageMessages, EventMessages>::Type;

// The compiler names what is missing.
static_assert((AllMessages::forEach([]<Message M>() {}), true));

// The names of all messages, by tag.
std::vector<std::string> messageNames();

inline constexpr std::uint8_t kWireVersion = 8;

}  // namespace rayshade

// parse() of a member of a closed list, chosen by its position.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "rayshade/base/type_list.h"
#include "rayshade/shapes/arguments.h"

namespace rayshade {

template <class Any, class T>
std::optional<Any> parseAs(Arguments& in) {
  auto parsed = T::parse(in);
  if (!parsed) return std::nullopt;
  return Any(std::move(*parsed));
}

template <class... T>
std::optional<std::variant<T...>> parseMemberOf(TypeList<T...>, std::size_t position, Arguments& in) {
  using Any = std::variant<T...>;
  static constexpr std::array<std::optional<Any> (*)(Arguments&), sizeof...(T)> kParsers{&parseAs<Any, T>...};
  return kParsers[position](in);
}

template <class List>
std::optional<typename List::Variant> parseMember(std::size_t position, Arguments& in) {
  return parseMemberOf(List{}, position, in);
}

}  // namespace rayshade

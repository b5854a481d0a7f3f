// A closed list of types.
//
// Shapes, textures, lights and atmospheric effects are closed families: the list in each all.h gives the
// parser its keywords, the wire its tags (the position in the list: append only) and the tests their
// subjects. Nothing registers itself at start-up, so there is nothing whose order could matter or that a
// linker could drop.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace rayshade {

template <class... T>
struct TypeList {
  using Variant = std::variant<T...>;
  using Vectors = std::tuple<std::vector<T>...>;
  static constexpr std::size_t size = sizeof...(T);

  // Calls f.template operator()<T>() for each type, in order.
  template <class F>
  static constexpr void forEach(F&& f) {
    (f.template operator()<T>(), ...);
  }
};

// The position of a type in a list.
template <class Wanted, class List>
struct PositionIn;
template <class Wanted, class... T>
struct PositionIn<Wanted, TypeList<T...>> {
  static constexpr std::size_t value = [] {
    std::size_t position = 0;
    bool found = false;
    ((std::is_same_v<Wanted, T> ? found = true : found ? true : (++position, false)), ...);
    return position;
  }();
};

template <class Wanted, class List>
inline constexpr bool kIsIn = PositionIn<Wanted, List>::value < List::size;

}  // namespace rayshade

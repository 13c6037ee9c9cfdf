// SPDX-License-Identifier: Apache-2.0
// For visitors of variants: what one has nothing to say about it lists by type, and a new
// alternative does not compile until every visitor says what it means:
//
//   void operator()(const OneOf<WaitStep, PlaceStep> auto&) const {}
//
// Tested by tests/harness/scenario/resolve/validate_planar_test.cc
#pragma once

#include <concepts>

namespace prehend::physics {

template <class T, class... Ts>
concept OneOf = (std::same_as<T, Ts> || ...);

/// A visitor made of lambdas.
template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;  // which Clang 14 does not find by itself

}  // namespace prehend::physics

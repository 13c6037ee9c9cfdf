// SPDX-License-Identifier: Apache-2.0
// Indices of bodies, hands and links as types of their own, so that the index of a hand cannot be
// taken for that of a body. Tested by tests/physics/base/ids_test.cc
#pragma once

#include <compare>
#include <concepts>
#include <cstddef>
#include <vector>

#include "physics/base/check.h"

namespace prehend::physics {

/// The index of nothing; every Index is this until it gets another one.
struct NoneType {};
inline constexpr NoneType kNone;

/// The place of a thing in the vector of such things.
template <typename Thing>
class Index {
 public:
  constexpr Index() = default;
  constexpr Index(NoneType) {}
  template <std::integral Number>
  constexpr explicit Index(Number number) : number_(static_cast<int>(number)) {}

  /// -1 of none.
  constexpr int number() const { return number_; }
  constexpr std::size_t index() const {
    PREHEND_DCHECK(number_ >= 0);
    return static_cast<std::size_t>(number_);
  }
  constexpr bool IsBelow(std::size_t size) const {
    return number_ >= 0 && static_cast<std::size_t>(number_) < size;
  }
  friend constexpr Index operator+(Index first, int offset) {
    return Index(first.number_ + offset);
  }
  friend constexpr bool operator==(Index, Index) = default;
  friend constexpr std::strong_ordering operator<=>(Index, Index) = default;

 private:
  int number_ = -1;
};

struct Body;
struct Hand;
struct HandLink;
using BodyIndex = Index<Body>;      ///< into Scene::bodies, and what has an element for each body
using HandIndex = Index<Hand>;      ///< into Scene::hands, likewise
using LinkIndex = Index<HandLink>;  ///< into HandModel::links, likewise; none: the palm

/// The element of a vector that has one for each such thing; the index is checked in debug builds.
template <typename T, typename Thing>
const T& At(const std::vector<T>& of_each, Index<Thing> index) {
  PREHEND_DCHECK(index.IsBelow(of_each.size()));
  return of_each[index.index()];
}
template <typename T, typename Thing>
T& At(std::vector<T>& of_each, Index<Thing> index) {
  PREHEND_DCHECK(index.IsBelow(of_each.size()));
  return of_each[index.index()];
}

}  // namespace prehend::physics

// SPDX-License-Identifier: Apache-2.0
// Numbers of things as types of their own, so that the number of a rule cannot be taken for that of
// a node; and vectors that only take numbers of their own things. An index is checked in debug
// builds. Tested by tests/grammar/base/ids_test.cc
#pragma once

#include <compare>
#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

#include "grammar/base/check.h"

namespace prehend::grammar {

/// The number of nothing: -1 as an int, and every Id has it until it gets another one.
struct NoneType {
  constexpr operator int() const { return -1; }
};
inline constexpr NoneType kNone;

/// The number of a thing; `Thing` is only a name for the type.
template <typename Thing>
class Id {
 public:
  constexpr Id() = default;
  constexpr Id(NoneType) {}
  template <std::integral Number>
  constexpr explicit Id(Number number) : number_(static_cast<int>(number)) {}

  constexpr int number() const { return number_; }
  constexpr std::size_t index() const {
    PREHEND_DCHECK(number_ >= 0);
    return static_cast<std::size_t>(number_);
  }
  constexpr Id& operator++() {
    ++number_;
    return *this;
  }
  friend constexpr bool operator==(Id, Id) = default;
  friend constexpr std::strong_ordering operator<=>(Id, Id) = default;

 private:
  int number_ = -1;
};

/// A vector whose elements are things with numbers of type `Key`.
template <typename Key, typename T>
class IdVector {
 public:
  IdVector() = default;
  explicit IdVector(std::size_t size, const T& value = T()) : items_(size, value) {}

  T& operator[](Key key) {
    PREHEND_DCHECK(key.index() < items_.size());
    return items_[key.index()];
  }
  const T& operator[](Key key) const {
    PREHEND_DCHECK(key.index() < items_.size());
    return items_[key.index()];
  }

  std::size_t size() const { return items_.size(); }
  bool empty() const { return items_.empty(); }
  bool has(Key key) const { return key >= Key(0) && key < end_id(); }
  /// The number of the next element to be added; all others are below it.
  Key end_id() const { return Key(items_.size()); }
  /// Returns the number of the new element.
  Key push_back(T item) {
    items_.push_back(std::move(item));
    return Key(items_.size() - 1);
  }
  void resize(std::size_t size) { items_.resize(size); }
  void clear() { items_.clear(); }
  T& back() { return items_.back(); }
  const T& back() const { return items_.back(); }

  auto begin() { return items_.begin(); }
  auto end() { return items_.end(); }
  auto begin() const { return items_.begin(); }
  auto end() const { return items_.end(); }

 private:
  std::vector<T> items_;
};

/// The numbers of a vector's elements, for `for`.
template <typename Key, typename T>
class IdsOf {
 public:
  explicit IdsOf(const IdVector<Key, T>& items) : end_(items.end_id()) {}
  struct Iterator {
    Key key;
    Key operator*() const { return key; }
    Iterator& operator++() {
      ++key;
      return *this;
    }
    friend bool operator==(const Iterator&, const Iterator&) = default;
  };
  Iterator begin() const { return {Key(0)}; }
  Iterator end() const { return {end_}; }

 private:
  Key end_;
};

// Things with numbers, each defined where its numbers come from.
struct Node;          // grammar/program/program.h
struct Rule;          // grammar/program/program.h
struct RuleInstance;  // grammar/state/instances.h
using NodeId = Id<Node>;
using RuleId = Id<Rule>;
using InstanceId = Id<RuleInstance>;

}  // namespace prehend::grammar

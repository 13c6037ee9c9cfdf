// SPDX-License-Identifier: Apache-2.0
// A growing sequence whose elements stay where they are, in blocks of many; an element is found by
// a shift and a mask. Tested by tests/grammar/state/stable_blocks_test.cc
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "grammar/base/ids.h"

namespace prehend::grammar {

template <typename Key, typename T>
class StableBlocks {
 public:
  std::size_t size() const { return size_; }
  /// The number of the next element to be added; all others are below it.
  Key end_id() const { return Key(size_); }

  T& operator[](Key key) {
    PREHEND_DCHECK(key.index() < size_);
    return (*blocks_[key.index() / kBlock])[key.index() % kBlock];
  }
  const T& operator[](Key key) const {
    PREHEND_DCHECK(key.index() < size_);
    return (*blocks_[key.index() / kBlock])[key.index() % kBlock];
  }

  T& PushBack() {
    if (size_ == kBlock * blocks_.size())
      blocks_.push_back(std::make_unique<std::array<T, kBlock>>());
    return (*this)[Key(size_++)];
  }

 private:
  static constexpr std::size_t kBlock = 64;  // a power of two
  std::vector<std::unique_ptr<std::array<T, kBlock>>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace prehend::grammar

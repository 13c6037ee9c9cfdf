// SPDX-License-Identifier: Apache-2.0
// A growing sequence whose elements stay where they are, in blocks of many: found by a shift and a
// mask. Tested by tests/grammar/engine/stable_blocks_test.cc
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "grammar/base/check.h"

namespace prehend::grammar {

template <typename T>
class StableBlocks {
 public:
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) {
    PREHEND_DCHECK(i < size_);
    return (*blocks_[i / kBlock])[i % kBlock];
  }
  const T& operator[](std::size_t i) const {
    PREHEND_DCHECK(i < size_);
    return (*blocks_[i / kBlock])[i % kBlock];
  }

  T& PushBack() {
    if (size_ == kBlock * blocks_.size())
      blocks_.push_back(std::make_unique<std::array<T, kBlock>>());
    return (*this)[size_++];
  }

 private:
  static constexpr std::size_t kBlock = 64;  // a power of two
  std::vector<std::unique_ptr<std::array<T, kBlock>>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// A queue in one block of memory: push at the back, drop at the front, index from the front.
// It doubles when full, and shrinks only when told to, so that a steady load stops allocating.
// Tested by tests/grammar/state/ring_buffer_test.cc
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "grammar/base/check.h"

namespace prehend::grammar {

template <typename T>
class RingBuffer {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// How many elements there is memory for.
  std::size_t capacity() const { return capacity_; }

  T& operator[](std::size_t i) {
    PREHEND_DCHECK(i < size_);
    return slots_[Slot(i)];
  }
  const T& operator[](std::size_t i) const {
    PREHEND_DCHECK(i < size_);
    return slots_[Slot(i)];
  }
  T& front() { return (*this)[0]; }
  const T& front() const { return (*this)[0]; }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }

  /// A new last element. It holds whatever an earlier element left there, so that its memory is
  /// used again.
  T& PushBack() {
    if (size_ == capacity_) MoveTo(slots_ == nullptr ? 2 : 2 * capacity_);
    ++size_;
    return back();
  }

  /// Prefetches the place of the element that PushBack() makes.
  void FetchNext() const {
    if (capacity_ == 0) return;
    const char* at = reinterpret_cast<const char*>(&slots_[Slot(size_)]);
    for (std::size_t line = 0; line < sizeof(T); line += 64) __builtin_prefetch(at + line, 1);
  }

  void PopFront() {
    PREHEND_DCHECK(size_ > 0);
    front_ = (front_ + 1) & (capacity_ - 1);
    --size_;
  }

  /// Keeps its memory.
  void Clear() { front_ = size_ = 0; }

  /// Gives back half of its memory; the other half suffices.
  void Halve() {
    PREHEND_DCHECK(size_ <= capacity_ / 2);
    MoveTo(capacity_ / 2);
  }

 private:
  std::uint32_t Slot(std::size_t i) const {
    return (front_ + static_cast<std::uint32_t>(i)) & (capacity_ - 1);
  }

  void MoveTo(std::uint32_t capacity) {
    std::unique_ptr<T[]> slots = std::make_unique<T[]>(capacity);
    for (std::uint32_t i = 0; i < size_; ++i) slots[i] = std::move((*this)[i]);
    slots_ = std::move(slots);
    capacity_ = capacity;
    front_ = 0;
  }

  std::unique_ptr<T[]> slots_;
  std::uint32_t capacity_ = 0;  // a power of two, once there is one
  std::uint32_t front_ = 0;
  std::uint32_t size_ = 0;
};

}  // namespace prehend::grammar

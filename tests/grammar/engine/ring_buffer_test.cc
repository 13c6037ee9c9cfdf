// SPDX-License-Identifier: Apache-2.0
#include "grammar/engine/ring_buffer.h"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace prehend::grammar {
namespace {

TEST(RingBuffer, BehavesAsADeque) {
  RingBuffer<int> ring;
  std::deque<int> deque;
  std::mt19937 random(1);
  for (int i = 0; i < 10000; ++i) {
    if (deque.empty() || random() % 100 < 55) {
      ring.PushBack() = i;
      deque.push_back(i);
    } else {
      ring.PopFront();
      deque.pop_front();
    }
    ASSERT_EQ(ring.size(), deque.size());
    if (deque.empty()) continue;
    const std::size_t k = random() % deque.size();
    ASSERT_EQ(ring[k], deque[k]);
    ASSERT_EQ(ring.front(), deque.front());
    ASSERT_EQ(ring.back(), deque.back());
  }
}

}  // namespace
}  // namespace prehend::grammar

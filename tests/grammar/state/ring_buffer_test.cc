// SPDX-License-Identifier: Apache-2.0
#include "grammar/state/ring_buffer.h"

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

TEST(RingBuffer, GivesHalfOfItsMemoryBack) {
  RingBuffer<int> ring;
  for (int i = 0; i < 20; ++i) ring.PushBack() = i;
  EXPECT_EQ(ring.capacity(), 32u);
  for (int i = 0; i < 17; ++i) ring.PopFront();
  for (int i = 20; i < 33; ++i) ring.PushBack() = i;  // around the end of the block
  ring.Halve();
  EXPECT_EQ(ring.capacity(), 16u);
  ASSERT_EQ(ring.size(), 16u);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(ring[static_cast<std::size_t>(i)], 17 + i);
  ring.PushBack() = 33;
  EXPECT_EQ(ring.capacity(), 32u);
  EXPECT_EQ(ring.back(), 33);
}

}  // namespace
}  // namespace prehend::grammar

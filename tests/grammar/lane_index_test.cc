// SPDX-License-Identifier: Apache-2.0
#include "grammar/lane_index.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace prehend::grammar {
namespace {

TEST(LaneIndex, BehavesAsAMap) {
  std::vector<LaneKey> keys(3000);
  for (int i = 0; i < 3000; ++i) keys[i] = {i % 3, {i / 60, i % 60, kNone, kNone}};
  const auto key_of = [&](int lane) -> const LaneKey& { return keys[lane]; };
  LaneIndex index;
  std::vector<bool> inside(keys.size());
  std::mt19937 random(1);
  for (int step = 0; step < 30000; ++step) {
    const int lane = static_cast<int>(random() % keys.size());
    ASSERT_EQ(index.Find(keys[lane], key_of), inside[lane] ? lane : kNone);
    // Fills and empties in turns, so that long runs of neighbours come and go.
    const bool insert = random() % 100 < (step / 5000 % 2 == 0 ? 80u : 20u);
    if (insert == inside[lane]) continue;
    insert ? index.Insert(lane, keys[lane]) : index.Erase(lane, keys[lane]);
    inside[lane] = insert;
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    ASSERT_EQ(index.Find(keys[i], key_of), inside[i] ? static_cast<int>(i) : kNone);
  }
}

}  // namespace
}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
#include "grammar/state/instance_index.h"

#include <gtest/gtest.h>

#include <random>

namespace prehend::grammar {
namespace {

template <typename Key>
void BehavesAsAMap(const std::vector<Key>& keys) {
  InstanceIndex<Key> index;
  std::vector<bool> inside(keys.size());
  std::mt19937 random(1);
  for (int step = 0; step < 30000; ++step) {
    const int instance = static_cast<int>(random() % keys.size());
    ASSERT_EQ(index.Find(keys[instance]), inside[instance] ? InstanceId(instance) : kNone);
    // Fills and empties in turns, so that long runs of neighbours come and go.
    const bool insert = random() % 100 < (step / 5000 % 2 == 0 ? 80u : 20u);
    if (insert == inside[instance]) continue;
    insert ? index.Insert(InstanceId(instance), keys[instance]) : index.Erase(keys[instance]);
    inside[instance] = insert;
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    ASSERT_EQ(index.Find(keys[i]), inside[i] ? InstanceId(i) : kNone);
  }
}

TEST(InstanceIndex, BehavesAsAMapOfBindings) {
  std::vector<InstanceKey> keys(3000);
  for (int i = 0; i < 3000; ++i) keys[i] = {RuleId(i % 3), {i / 60, i % 60, kNone, kNone}};
  BehavesAsAMap(keys);
}

TEST(InstanceIndex, BehavesAsAMapOfPairs) {
  std::vector<PairKey> keys(3000);
  for (int i = 0; i < 3000; ++i) keys[i] = PairKey(i / 60, 60 + i % 60);
  BehavesAsAMap(keys);
}

TEST(InstanceIndex, APairHasNoOrder) {
  InstanceIndex<PairKey> index;
  index.Insert(InstanceId(7), PairKey(2, 1));
  EXPECT_EQ(index.Find(PairKey(1, 2)), InstanceId(7));
  EXPECT_EQ(index.Find(PairKey(2, 2)), kNone);
}

}  // namespace
}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/base/timeline.h"

namespace prehend::grammar {
namespace {

TEST(IntervalSet, UnionJoinsWhatOverlapsOrFollowsAtOnce) {
  const IntervalSet set = Union({{10, 20}, {0, 5}, {20, 30}, {3, 4}, {7, 7}});
  EXPECT_EQ(set, (IntervalSet{{0, 5}, {10, 30}}));
  EXPECT_EQ(Without({2, 40}, set), (IntervalSet{{5, 10}, {30, 40}}));
  EXPECT_EQ(Without({10, 30}, set), IntervalSet{});
  EXPECT_EQ(Without({4, 11}, set), (IntervalSet{{5, 10}}));
}

}  // namespace
}  // namespace prehend::grammar

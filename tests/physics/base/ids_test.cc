// SPDX-License-Identifier: Apache-2.0
#include "physics/base/ids.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace prehend::physics {
namespace {

TEST(Index, IsNoneUntilItGetsANumber) {
  EXPECT_EQ(BodyIndex(), kNone);
  EXPECT_EQ(BodyIndex().number(), -1);
  EXPECT_EQ(BodyIndex(3).index(), 3U);
  EXPECT_EQ(BodyIndex(3) + 2, BodyIndex(5));
  EXPECT_LT(BodyIndex(kNone), BodyIndex(0));
  EXPECT_TRUE(BodyIndex(1).IsBelow(2));
  EXPECT_FALSE(BodyIndex(2).IsBelow(2));
  EXPECT_FALSE(BodyIndex().IsBelow(2));
}

TEST(Index, IsNeitherANumberNorTheIndexOfAnotherThing) {
  static_assert(!std::is_convertible_v<int, BodyIndex>);
  static_assert(!std::is_convertible_v<BodyIndex, int>);
  static_assert(!std::is_constructible_v<BodyIndex, HandIndex>);
  static_assert(!std::equality_comparable_with<HandIndex, LinkIndex>);
  static_assert(sizeof(LinkIndex) == sizeof(int));
}

TEST(Index, IsCheckedInDebugBuilds) {
#ifdef PREHEND_DEBUG_CHECKS
  const std::vector<int> of_each(2);
  EXPECT_THROW(At(of_each, BodyIndex(2)), std::logic_error);
  EXPECT_THROW(At(of_each, BodyIndex()), std::logic_error);
#else
  GTEST_SKIP() << "built without PREHEND_DEBUG_CHECKS";
#endif
}

}  // namespace
}  // namespace prehend::physics

// SPDX-License-Identifier: Apache-2.0
#include "grammar/base/ids.h"

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

namespace prehend::grammar {
namespace {

using CupId = Id<struct CupTag>;
using PlateId = Id<struct PlateTag>;

TEST(Id, IsNoneUntilItGetsANumber) {
  EXPECT_EQ(CupId(), kNone);
  EXPECT_EQ(CupId().number(), -1);
  EXPECT_EQ(CupId(3).number(), 3);
  EXPECT_EQ(CupId(3).index(), 3U);
  EXPECT_LT(CupId(kNone), CupId(0));
  const int number = kNone;
  EXPECT_EQ(number, -1);
}

TEST(Id, IsNeitherANumberNorTheIdOfAnotherThing) {
  static_assert(!std::is_convertible_v<int, CupId>);
  static_assert(!std::is_convertible_v<CupId, int>);
  static_assert(!std::is_constructible_v<CupId, PlateId>);
  static_assert(!std::equality_comparable_with<CupId, PlateId>);
  static_assert(sizeof(CupId) == sizeof(int));
}

TEST(IdVector, GivesNumbersToItsElements) {
  IdVector<CupId, std::string> cups;
  EXPECT_EQ(cups.end_id(), CupId(0));
  EXPECT_EQ(cups.push_back("red"), CupId(0));
  EXPECT_EQ(cups.push_back("blue"), CupId(1));
  EXPECT_EQ(cups[CupId(1)], "blue");
  cups[CupId(0)] = "green";
  std::string all;
  for (const CupId cup : IdsOf(cups)) all += std::to_string(cup.number()) + cups[cup] + " ";
  EXPECT_EQ(all, "0green 1blue ");
  EXPECT_TRUE(cups.has(CupId(1)));
  EXPECT_FALSE(cups.has(CupId(2)));
  EXPECT_FALSE(cups.has(kNone));
}

TEST(IdVector, ChecksItsIndicesInDebugBuilds) {
#ifdef PREHEND_DEBUG_CHECKS
  IdVector<CupId, int> cups(2);
  EXPECT_THROW(cups[CupId(2)], std::logic_error);
  EXPECT_THROW(cups[kNone], std::logic_error);
#else
  GTEST_SKIP() << "built without PREHEND_DEBUG_CHECKS";
#endif
}

}  // namespace
}  // namespace prehend::grammar

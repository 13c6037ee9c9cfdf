// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/number_text.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace prehend {
namespace {

TEST(NumberFrom, IsAllOfTheText) {
  EXPECT_EQ(NumberFrom<double>("-2.5e1"), -25);
  EXPECT_EQ(NumberFrom<int>("-7"), -7);
  for (const char* none : {"", " 1", "1 ", "+1", "1,5", "1cm", "x"}) {
    EXPECT_EQ(NumberFrom<double>(none), std::nullopt) << none;
    EXPECT_EQ(NumberFrom<int>(none), std::nullopt) << none;
  }
  EXPECT_EQ(NumberFrom<int>("1.5"), std::nullopt);
}

TEST(NumberFrom, FitsItsType) {
  EXPECT_EQ(NumberFrom<std::uint64_t>("18446744073709551615"), UINT64_MAX);
  EXPECT_EQ(NumberFrom<std::uint64_t>("18446744073709551616"), std::nullopt);
  EXPECT_EQ(NumberFrom<std::uint64_t>("-1"), std::nullopt);
  EXPECT_EQ(NumberFrom<double>("1e999"), std::nullopt);
}

TEST(LowerCase, IsOfAsciiAlone) {
  EXPECT_EQ(LowerCase("Cup_POS-x.2"), "cup_pos-x.2");
  EXPECT_EQ(LowerCase("\xC3\x84@[`{"), "\xC3\x84@[`{") << "other bytes stay";
}

TEST(EndingOf, IsSmallAndTheLastOne) {
  EXPECT_EQ(EndingOf("takes/Take.1.CSV"), ".csv");
  EXPECT_EQ(EndingOf("takes.d/take"), "");
}

}  // namespace
}  // namespace prehend

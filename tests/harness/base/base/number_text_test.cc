// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/number_text.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace prehend {
namespace {

TEST(WholeNumber, IsAllOfTheText) {
  EXPECT_EQ(WholeNumber<double>("-2.5e1"), -25);
  EXPECT_EQ(WholeNumber<int>("-7"), -7);
  for (const char* none : {"", " 1", "1 ", "+1", "1,5", "1cm", "x"}) {
    EXPECT_EQ(WholeNumber<double>(none), std::nullopt) << none;
    EXPECT_EQ(WholeNumber<int>(none), std::nullopt) << none;
  }
  EXPECT_EQ(WholeNumber<int>("1.5"), std::nullopt);
}

TEST(WholeNumber, FitsItsType) {
  EXPECT_EQ(WholeNumber<std::uint64_t>("18446744073709551615"), UINT64_MAX);
  EXPECT_EQ(WholeNumber<std::uint64_t>("18446744073709551616"), std::nullopt);
  EXPECT_EQ(WholeNumber<std::uint64_t>("-1"), std::nullopt);
  EXPECT_EQ(WholeNumber<double>("1e999"), std::nullopt);
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

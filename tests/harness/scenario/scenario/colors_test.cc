// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/scenario/scenario/scenario.h"

namespace prehend::scenario {
namespace {

TEST(ColorsTest, AWordOrSixHexadecimalDigitsAreAColor) {
  EXPECT_EQ(ColorOfText("#0a1B2c"), 0x0A1B2Cu);
  EXPECT_EQ(ColorOfText("blue"), ColorInName("blue"));
  for (const char* no_color :
       {"", "#", "#12345", "#1234567", "#12345g", "#-12345", "Blue", "bluish"})
    EXPECT_FALSE(ColorOfText(no_color)) << no_color;
  for (const std::string& word : ColorWords()) EXPECT_TRUE(ColorOfText(word)) << word;
}

TEST(ColorsTest, AWordInANameIsAWholePartOfIt) {
  EXPECT_EQ(ColorInName("blue_cup"), ColorOfText("blue"));
  EXPECT_EQ(ColorInName("small_red"), ColorOfText("red"));
  EXPECT_FALSE(ColorInName("bluebell_cup"));
  EXPECT_FALSE(ColorInName("hundred"));
  EXPECT_FALSE(ColorInName(""));
}

}  // namespace
}  // namespace prehend::scenario

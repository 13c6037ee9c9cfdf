// SPDX-License-Identifier: Apache-2.0
#include "grammar/base/quantity.h"

#include <gtest/gtest.h>

#include "grammar/language/parser.h"

namespace prehend::grammar {
namespace {

TEST(Quantity, IsReadInSiUnitsAndShownAgain) {
  const std::pair<const char*, const char*> cases[] = {
      {"25 cm", "0.25 m"},   {"0.3", "0.3"},
      {"-60 ms", "-0.06 s"}, {"2 cm/s", "0.02 m/s"},
      {"5 N", "5 N"},        {"180 deg", "3.141592653589793 rad"},
      {"1e3 mm", "1 m"},     {"9.81 m/s/s", "9.81 m/s/s"}};
  for (const auto& [text, shown] : cases) {
    Diagnostics diagnostics;
    const std::optional<Quantity> quantity = ParseQuantity({"v", text}, diagnostics);
    ASSERT_TRUE(quantity) << text << Format(diagnostics);
    EXPECT_EQ(QuantityText(*quantity), shown);
  }
}

TEST(Quantity, IsReadableWhereOneUnitHasFewerDigitsThanAnother) {
  const std::pair<const char*, const char*> cases[] = {
      {"35 cm", "0.35 m"},      {"25 cm", "0.25 m"}, {"20 deg", "20 deg"}, {"35 cm/s", "0.35 m/s"},
      {"20 deg/s", "20 deg/s"}, {"2.9", "2.9"},      {"1 rad", "1 rad"},   {"60 ms", "0.06 s"}};
  for (const auto& [text, shown] : cases) {
    Diagnostics diagnostics;
    const std::optional<Quantity> quantity = ParseQuantity({"v", text}, diagnostics);
    ASSERT_TRUE(quantity) << text << Format(diagnostics);
    EXPECT_EQ(ReadableQuantityText(*quantity), shown);
  }
  EXPECT_EQ(ReadableQuantityText({1.0 / 3, kMetres}), "0.3333333333333333 m");
}

// 570 * 0.001 and 0.1 + 0.2 lie beside the numbers that are meant.
TEST(Quantity, IsTheNumberThatIsWritten) {
  const std::pair<const char*, const char*> cases[] = {
      {"570 ms", "0.57 s"},       {"57 cm", "0.57 m"},
      {"-290 mm/s", "-0.29 m/s"}, {"0.123456789012345 m", "0.123456789012345 m"},
      {"1e-20 cm", "1e-22 m"},    {"90 deg", "1.5707963267948966 rad"}};
  for (const auto& [text, shown] : cases) {
    Diagnostics diagnostics;
    EXPECT_EQ(QuantityText(*ParseQuantity({"v", text}, diagnostics)), shown);
  }
  EXPECT_EQ(AsWritten(0.1 + 0.2), 0.3);
  EXPECT_EQ(AsWritten(-0.0), 0);
  EXPECT_EQ(AsWritten(1.0 / 3), 1.0 / 3);
  EXPECT_EQ(AsWritten(0.3 + 1e-13), 0.3 + 1e-13);
  EXPECT_EQ(AsWritten(HUGE_VAL), HUGE_VAL);
}

TEST(Quantity, RefusesWhatIsNone) {
  for (const char* text : {"", "cm", "3 apples", "3 cm 4", "1e999", "\x01", "3 cm s"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(ParseQuantity({"v", text}, diagnostics)) << text;
    EXPECT_FALSE(diagnostics.empty()) << text;
  }
}

}  // namespace
}  // namespace prehend::grammar

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
      {"35 cm", "35 cm"},       {"25 cm", "0.25 m"}, {"20 deg", "20 deg"}, {"35 cm/s", "35 cm/s"},
      {"20 deg/s", "20 deg/s"}, {"2.9", "2.9"},      {"1 rad", "1 rad"},   {"60 ms", "0.06 s"}};
  for (const auto& [text, shown] : cases) {
    Diagnostics diagnostics;
    const std::optional<Quantity> quantity = ParseQuantity({"v", text}, diagnostics);
    ASSERT_TRUE(quantity) << text << Format(diagnostics);
    EXPECT_EQ(ReadableQuantityText(*quantity), shown);
  }
  EXPECT_EQ(ReadableQuantityText({1.0 / 3, kMetres}), "0.3333333333333333 m");
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

// SPDX-License-Identifier: Apache-2.0
#include "tests/witnesses/closed_form/formula.h"

#include <gtest/gtest.h>

namespace prehend::witnesses {
namespace {

double ValueOf(const std::string& text) {
  const auto formula = FormulaScope().Read(text);
  EXPECT_TRUE(formula.has_value()) << text << ": " << formula.error().message;
  return formula ? formula->Value() : 0;
}

TEST(Formula, HasArithmeticComparisonsAndChoice) {
  EXPECT_DOUBLE_EQ(ValueOf("1 + 2 * 3^2 / 4 - 0.5"), 5);
  EXPECT_DOUBLE_EQ(ValueOf("2 >= 1 && 1 != 3 ? sqrt(16) : 0"), 4);
  EXPECT_DOUBLE_EQ(ValueOf("cos(_pi)"), -1);
}

TEST(Formula, RampsBetweenTwoMoments) {
  EXPECT_EQ(ValueOf("ramp(0.9, 1, 3)"), 0);
  EXPECT_EQ(ValueOf("ramp(1.5, 1, 3)"), 0.25);
  EXPECT_EQ(ValueOf("ramp(3.1, 1, 3)"), 1);
  EXPECT_EQ(ValueOf("ramp(1, 1, 1)"), 0) << "a jump happens after its moment";
}

TEST(Formula, RemaindersAreNeverNegative) {
  EXPECT_EQ(ValueOf("mod(7, 3)"), 1);
  EXPECT_EQ(ValueOf("mod(-1, 3)"), 2);
}

TEST(Formula, FollowsTheVariablesOfItsScope) {
  FormulaScope scope;
  scope.AddConstant("v", 2);
  double& t = scope.AddVariable("t");
  const auto formula = scope.Read("v * t");
  ASSERT_TRUE(formula.has_value());
  t = 3;
  EXPECT_EQ(formula->Value(), 6);
  t = 4;
  EXPECT_EQ(formula->Value(), 8);
}

TEST(Formula, KeepsItsScopesVariablesAlive) {
  double* t = nullptr;
  const Formula formula = [&] {
    FormulaScope scope;
    t = &scope.AddVariable("t");
    return *scope.Read("t + 1");
  }();
  *t = 2;
  EXPECT_EQ(formula.Value(), 3);
}

struct Wrong {
  const char* text;
  const char* message;
  int offset;
};

TEST(Formula, SaysWhatIsWrongAndWhere) {
  FormulaScope scope;
  scope.AddVariable("t");
  for (const Wrong& wrong : std::initializer_list<Wrong>{
           {"1 + tt", "unknown name 'tt'", 4},
           {"1 +", "the formula ends too early", 3},
           {"(1 + 2", "a ')' is missing", 6},
           {"t = 3", "unexpected '='; to compare, write '=='", 2},
           {"1, 2", "expected one formula, found several with ',' between them", 0},
           {"mod(1)", "too few arguments of 'mod'", 5},
           {"mod(1, 2, 3)", "too many arguments of 'mod'", 11},
           {"1 2", "unexpected '2'", 2},
           {"t $ 2", "unknown name '$ 2'", 2},
           {"", "the formula ends too early", 0}}) {
    const auto formula = scope.Read(wrong.text);
    ASSERT_FALSE(formula.has_value()) << wrong.text;
    EXPECT_EQ(formula.error().message, wrong.message) << wrong.text;
    EXPECT_EQ(formula.error().offset, wrong.offset) << wrong.text;
  }
}

}  // namespace
}  // namespace prehend::witnesses

// SPDX-License-Identifier: Apache-2.0
// What comparisons of ranges are: never, always or sometimes true.
#include "grammar/analysis/value_ranges.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prehend::grammar {
namespace {

constexpr Range Point(double value) { return {.low = value, .high = value}; }

TEST(Ranges, ComparisonsAreNeverOrAlwaysTrueBeyondTheEnds) {
  const Range share{.low = 0, .high = 1};
  const struct {
    Op op;
    double value;
    Verdict verdict;
  } cases[] = {
      {Op::kLess, 0, Verdict::kNever},
      {Op::kLess, 1, Verdict::kPossible},
      {Op::kLess, 1.1, Verdict::kAlways},
      {Op::kLessEqual, -0.1, Verdict::kNever},
      {Op::kLessEqual, 0, Verdict::kPossible},
      {Op::kLessEqual, 1, Verdict::kAlways},
      {Op::kGreater, 1, Verdict::kNever},
      {Op::kGreater, 0, Verdict::kPossible},
      {Op::kGreater, -0.1, Verdict::kAlways},
      {Op::kGreaterEqual, 1.1, Verdict::kNever},
      {Op::kGreaterEqual, 1, Verdict::kPossible},
      {Op::kGreaterEqual, 0, Verdict::kAlways},
      {Op::kEqual, 2, Verdict::kNever},
      {Op::kEqual, 1, Verdict::kPossible},
      {Op::kNotEqual, 2, Verdict::kAlways},
      {Op::kNotEqual, 0.5, Verdict::kPossible},
  };
  for (const auto& c : cases)
    EXPECT_EQ(Judge(c.op, share, Point(c.value)), c.verdict)
        << static_cast<int>(c.op) << " " << c.value;
}

TEST(Ranges, CountsAreWhole) {
  const Range count{.low = 0, .high = 5, .whole = true};
  EXPECT_EQ(Judge(Op::kEqual, count, Point(2.5)), Verdict::kNever);
  EXPECT_EQ(Judge(Op::kNotEqual, count, Point(2.5)), Verdict::kAlways);
  EXPECT_EQ(Judge(Op::kEqual, count, Point(2)), Verdict::kPossible);
}

// What is known of a whole is what its parts allow, and nothing where a part may be zero or
// infinite.
TEST(Ranges, FollowArithmetic) {
  Program program;
  const auto add = [&](Node node) { return program.nodes.push_back(node); };
  const auto both = [&](Op op, NodeId a, NodeId b) {
    return add({.op = op, .args = {a, b, kNone, kNone}});
  };
  const NodeId grip = add({.op = Op::kTrigger});
  const NodeId up = add({.op = Op::kUp});
  const NodeId force = add({.op = Op::kForceBetween});
  const NodeId two = add({.op = Op::kNumber, .number = 2});
  const auto expect = [&](NodeId node, double low, double high) {
    const Range range = RangeOf(program, {}, node);
    EXPECT_DOUBLE_EQ(range.low, low) << node.number();
    EXPECT_DOUBLE_EQ(range.high, high) << node.number();
  };
  expect(both(Op::kAdd, grip, two), 2, 3);
  expect(both(Op::kSubtract, grip, up), -1, 2);
  expect(both(Op::kMultiply, up, two), -2, 2);
  expect(both(Op::kDivide, up, two), -0.5, 0.5);
  expect(both(Op::kDivide, two, grip), -INFINITY, INFINITY);
  expect(both(Op::kSubtract, force, two), -2, INFINITY);
  expect(both(Op::kMultiply, force, up), -INFINITY, INFINITY);
  expect(add({.op = Op::kNegate, .args = {force, kNone, kNone, kNone}}), -INFINITY, 0);
  expect(add({.op = Op::kAbs, .args = {up, kNone, kNone, kNone}}), 0, 1);
}

}  // namespace
}  // namespace prehend::grammar

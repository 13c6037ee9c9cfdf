// SPDX-License-Identifier: Apache-2.0
// Interval arithmetic over the nodes of a program.
#include "grammar/analysis/value_ranges.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace prehend::grammar {
namespace {

// The smallest range with all of them in it; everything if one of them means nothing, as infinity
// minus infinity does.
Range Around(std::initializer_list<double> values) {
  if (std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }))
    return {};
  return {.low = std::min(values), .high = std::max(values)};
}

Range Times(const Range& a, const Range& b) {
  return Around({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
}

Range Over(const Range& a, const Range& b) {
  if (b.low <= 0 && b.high >= 0) return {};
  return Around({a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high});
}

Range Magnitude(const Range& a) {
  const double nearest =
      a.low <= 0 && a.high >= 0 ? 0 : std::min(std::abs(a.low), std::abs(a.high));
  return {.low = nearest, .high = std::max(std::abs(a.low), std::abs(a.high)), .whole = a.whole};
}

bool Misses(const Range& counts, const Range& value) {
  return counts.whole && value.IsPoint() && value.low != std::floor(value.low);
}

}  // namespace

Verdict Opposite(Verdict verdict) {
  if (verdict == Verdict::kPossible) return verdict;
  return verdict == Verdict::kNever ? Verdict::kAlways : Verdict::kNever;
}

Range RangeOf(const Program& program, const Rule& rule, NodeId index) {
  const Node& node = program.nodes[index];
  if (node.op == Op::kAtBegin)
    return RangeOf(program, rule, rule.anchors[static_cast<std::size_t>(node.slot)]);
  if (node.op == Op::kCount) return {.low = node.number, .whole = true};
  if (node.op == Op::kNumber) return {.low = node.number, .high = node.number};
  if (!RowOf(node.op).is_made) return RowOf(node.op).range;
  const Range a = RangeOf(program, rule, node.args[0]);
  const Range b = node.args[1] == kNone ? a : RangeOf(program, rule, node.args[1]);
  if (node.op == Op::kAdd) return Around({a.low + b.low, a.high + b.high});
  if (node.op == Op::kSubtract) return Around({a.low - b.high, a.high - b.low});
  if (node.op == Op::kMultiply) return Times(a, b);
  if (node.op == Op::kDivide) return Over(a, b);
  if (node.op == Op::kNegate) return Times(a, {.low = -1, .high = -1});
  if (node.op == Op::kAbs) return Magnitude(a);
  return {.low = a.low, .high = a.high, .whole = a.whole && node.op != Op::kMean};
}

Verdict Judge(Op op, const Range& left, const Range& right) {
  if (op == Op::kGreater) return Judge(Op::kLess, right, left);
  if (op == Op::kLessEqual) return Opposite(Judge(Op::kLess, right, left));
  if (op == Op::kGreaterEqual) return Opposite(Judge(Op::kLess, left, right));
  if (op == Op::kNotEqual) return Opposite(Judge(Op::kEqual, left, right));
  if (op == Op::kLess && left.low >= right.high) return Verdict::kNever;
  if (op == Op::kLess) return left.high < right.low ? Verdict::kAlways : Verdict::kPossible;
  if (left.low > right.high || left.high < right.low || Misses(left, right) || Misses(right, left))
    return Verdict::kNever;
  return left.IsPoint() && right.IsPoint() ? Verdict::kAlways : Verdict::kPossible;
}

std::string RangeText(const Range& range, const Dimension& dimension) {
  const auto text = [&](double value) {
    constexpr int kDigits = 6;  // what was computed has no more that people want to see
    char digits[32];
    value *= dimension.angle == 1 ? 180 / std::numbers::pi : 1;
    const auto written =
        std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, kDigits);
    std::from_chars(digits, written.ptr, value);
    std::string quantity = QuantityText({value, dimension});
    if (dimension.angle == 1)
      quantity.replace(quantity.find("rad"), 3, "deg");  // as people write angles
    return quantity;
  };
  const bool from_below = std::isfinite(range.low);
  const bool from_above = std::isfinite(range.high);
  const std::string counted = range.whole ? " in whole numbers" : "";
  if (from_below && from_above)
    return "goes from " + text(range.low) + " to " + text(range.high) + counted;
  if (from_below) return "is never below " + text(range.low);
  return from_above ? "is never above " + text(range.high) : "can be any number";
}

std::string Signature(const Program& program, const Rule& rule, NodeId index) {
  const Node& node = program.nodes[index];
  if (node.op == Op::kAtBegin)
    return "@begin(" + Signature(program, rule, rule.anchors[node.slot]) + ")";
  std::vector<std::string> args;
  for (const NodeId arg : node.args) {
    if (arg != kNone) args.push_back(Signature(program, rule, arg));
  }
  std::vector<int> roles(node.roles.begin(), node.roles.end());
  std::string text = std::to_string(static_cast<int>(node.op)) + "n" + std::to_string(node.name) +
                     ":" + QuantityText({node.number, kPlain});
  bool both_ways = RowOf(node.op).both_ways;
  if (node.op == Op::kHolds) {
    const Reference& reference = rule.references[node.slot];
    roles.assign(reference.roles.begin(), reference.roles.end());
    text += "e" + std::to_string(reference.rule.number());
    both_ways = program.rules[reference.rule].symmetric;
  }
  if (node.op == Op::kIsA) text += program.class_names[node.slot];
  if (both_ways) {
    std::sort(args.begin(), args.end());
    std::sort(roles.begin(), roles.begin() + 2);
  }
  for (const int role : roles) text += "r" + std::to_string(role);
  for (const std::string& arg : args) text += "(" + arg + ")";
  return text;
}

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// Interval arithmetic over the nodes of a program.
#include "grammar/analysis/value_ranges.h"

#include <algorithm>
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

Range OfSignal(const Node& node) {
  const Builtin* builtin = FindBuiltin(node.op);
  return builtin == nullptr ? Range{} : builtin->range;
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
  const auto arg = [&](std::size_t i) { return RangeOf(program, rule, node.args[i]); };
  switch (node.op) {
    case Op::kCount:
      return {.low = node.number, .whole = true};
    case Op::kNumber:
      return {.low = node.number, .high = node.number};
    case Op::kAdd: {
      const Range a = arg(0);
      const Range b = arg(1);
      return Around({a.low + b.low, a.high + b.high});
    }
    case Op::kSubtract: {
      const Range a = arg(0);
      const Range b = arg(1);
      return Around({a.low - b.high, a.high - b.low});
    }
    case Op::kMultiply:
      return Times(arg(0), arg(1));
    case Op::kDivide:
      return Over(arg(0), arg(1));
    case Op::kNegate:
      return Times(arg(0), {.low = -1, .high = -1});
    case Op::kAbs:
      return Magnitude(arg(0));
    case Op::kAtBegin:
      return RangeOf(program, rule, rule.anchors[node.slot]);
    case Op::kAtEnd:
    case Op::kMinimum:
    case Op::kMaximum:
    case Op::kMedian:
      return arg(0);
    case Op::kMean: {
      const Range a = arg(0);
      return {.low = a.low, .high = a.high};
    }
    default:
      return OfSignal(node);
  }
}

Verdict Judge(Op op, const Range& left, const Range& right) {
  switch (op) {
    case Op::kLess:
      if (left.low >= right.high) return Verdict::kNever;
      return left.high < right.low ? Verdict::kAlways : Verdict::kPossible;
    case Op::kLessEqual:
      return Opposite(Judge(Op::kLess, right, left));
    case Op::kGreater:
      return Judge(Op::kLess, right, left);
    case Op::kGreaterEqual:
      return Opposite(Judge(Op::kLess, left, right));
    case Op::kEqual:
      if (left.low > right.high || left.high < right.low || Misses(left, right) ||
          Misses(right, left))
        return Verdict::kNever;
      return left.IsPoint() && right.IsPoint() ? Verdict::kAlways : Verdict::kPossible;
    default:
      return Opposite(Judge(Op::kEqual, left, right));
  }
}

std::string RangeText(const Range& range, const Dimension& dimension) {
  const auto text = [&](double value) {
    std::string quantity =
        QuantityText({value * (dimension.angle == 1 ? 180 / std::numbers::pi : 1), dimension});
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
  bool either_way =
      node.op == Op::kForceBetween || node.op == Op::kTouchSpeed || node.op == Op::kDistance;
  if (node.op == Op::kHolds) {
    const Reference& reference = rule.references[node.slot];
    roles.assign(reference.roles.begin(), reference.roles.end());
    text += "e" + std::to_string(reference.rule.number());
    either_way = program.rules[reference.rule].symmetric;
  }
  if (node.op == Op::kIsA) text += program.class_names[node.slot];
  if (either_way) {
    std::sort(args.begin(), args.end());
    std::sort(roles.begin(), roles.begin() + 2);
  }
  for (const int role : roles) text += "r" + std::to_string(role);
  for (const std::string& arg : args) text += "(" + arg + ")";
  return text;
}

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
#include "grammar/bounds.h"

#include <limits>
#include <utility>

namespace prehend::grammar {
namespace {

// The same for the same expression.
std::string Signature(const Program& program, int index) {
  const Node& node = program.nodes[index];
  std::string text = std::to_string(static_cast<int>(node.op));
  for (const int role : node.roles) text += "r" + std::to_string(role);
  text += "s" + std::to_string(node.slot) + "t" + std::to_string(node.name) + "n" + std::to_string(node.number) + "(";
  for (const int arg : node.args) {
    if (arg != kNone) text += Signature(program, arg) + ",";
  }
  return text + ")";
}

// `a op b` as `b op a`.
Op Mirrored(Op op) {
  switch (op) {
    case Op::kLess: return Op::kGreater;
    case Op::kLessEqual: return Op::kGreaterEqual;
    case Op::kGreater: return Op::kLess;
    case Op::kGreaterEqual: return Op::kLessEqual;
    default: return op;
  }
}

Op Negated(Op op) {
  switch (op) {
    case Op::kLess: return Op::kGreaterEqual;
    case Op::kLessEqual: return Op::kGreater;
    case Op::kGreater: return Op::kLessEqual;
    case Op::kGreaterEqual: return Op::kLess;
    case Op::kEqual: return Op::kNotEqual;
    default: return Op::kEqual;
  }
}

}  // namespace

bool Bounds::Add(int index, bool negated) {
  const Node& node = program_.nodes[index];
  switch (node.op) {
    case Op::kNot: return Add(node.args[0], !negated);
    case Op::kAnd: return negated || (Add(node.args[0]) && Add(node.args[1]));
    case Op::kOr: return !negated || (Add(node.args[0], true) && Add(node.args[1], true));
    case Op::kLess: case Op::kLessEqual: case Op::kGreater: case Op::kGreaterEqual: case Op::kEqual: case Op::kNotEqual:
      break;
    case Op::kBegins: case Op::kEnds: return true;  // a change does not contradict the state
    default: return Narrow(Signature(program_, index), Op::kEqual, negated ? 0 : 1);
  }
  const Op op = negated ? Negated(node.op) : node.op;
  const Node& left = program_.nodes[node.args[0]];
  const Node& right = program_.nodes[node.args[1]];
  if (right.op == Op::kNumber) return Narrow(Signature(program_, node.args[0]), op, right.number);
  if (left.op == Op::kNumber) return Narrow(Signature(program_, node.args[1]), Mirrored(op), left.number);
  return true;
}

bool Bounds::Narrow(const std::string& value, Op op, double number) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Limit& limit = limits_.try_emplace(value, Limit{-kInfinity, kInfinity}).first->second;
  const bool from_below = op == Op::kGreater || op == Op::kGreaterEqual || op == Op::kEqual;
  const bool from_above = op == Op::kLess || op == Op::kLessEqual || op == Op::kEqual;
  if (from_below && (number > limit.low || (number == limit.low && op == Op::kGreater))) {
    limit.low = number;
    limit.low_open = op == Op::kGreater;
  }
  if (from_above && (number < limit.high || (number == limit.high && op == Op::kLess))) {
    limit.high = number;
    limit.high_open = op == Op::kLess;
  }
  if (limit.low == limit.high) return !limit.low_open && !limit.high_open;
  return limit.low < limit.high;
}

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// A value is described by its expression, with roles in the order in which it names them: that of
// `speed(hand, 150 ms)` is the same in every rule, whatever the role is called there. A window is
// the same whatever is asked for in it.
#include "grammar/analysis/share_values.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "grammar/analysis/builtins.h"

namespace prehend::grammar {
namespace {

bool CostsTime(Op op) {
  const bool windowed = HasWindow(op) && op != Op::kDriftAlong;
  return windowed || op == Op::kClearance || op == Op::kGap;
}

// Those that look at poses and nothing else: neither at touches, nor at other rules, nor at the
// begin or the end of an interval.
bool LooksAtPosesOnly(Op op) {
  switch (op) {
    case Op::kNumber:
    case Op::kAdd:
    case Op::kSubtract:
    case Op::kMultiply:
    case Op::kDivide:
    case Op::kNegate:
    case Op::kAbs:
    case Op::kDistance:
    case Op::kHeight:
    case Op::kPosition:
    case Op::kPositionOn:
    case Op::kSpeed:
    case Op::kVerticalSpeed:
    case Op::kRelativeVerticalSpeed:
    case Op::kRelativeSpeed:
    case Op::kTilt:
      return true;
    default:
      return CostsTime(op);
  }
}

// False if it depends on more than poses. Appends to the text what the value is.
bool Describe(const Program& program, NodeId index, std::vector<int>& roles, std::string& text) {
  const Node& node = program.nodes[index];
  if (!LooksAtPosesOnly(node.op) || node.slot != kNone) return false;
  text += std::to_string(static_cast<int>(node.op)) + "," + std::to_string(node.number) + "(";
  for (const int role : node.roles) {
    if (role == kNone) continue;
    const auto found = std::ranges::find(roles, role);
    text += "r" + std::to_string(found - roles.begin());
    if (found == roles.end()) roles.push_back(role);
  }
  for (const NodeId arg : node.args) {
    if (arg != kNone && !Describe(program, arg, roles, text)) return false;
  }
  text += ")";
  return true;
}

// What every value of the node is made of; kAtEnd itself, too. A window that is too short for a
// value does not ask for it.
bool NeedsEnd(const Program& program, NodeId index) {
  if (index == kNone) return false;
  const Node& node = program.nodes[index];
  switch (node.op) {
    case Op::kAtEnd:
      return true;
    case Op::kLess:
    case Op::kLessEqual:
    case Op::kGreater:
    case Op::kGreaterEqual:
    case Op::kEqual:
    case Op::kNotEqual:
    case Op::kInSphere:
    case Op::kSolidInSphere:
    case Op::kInCylinder:
    case Op::kAdd:
    case Op::kSubtract:
    case Op::kMultiply:
    case Op::kDivide:
    case Op::kNegate:
    case Op::kAbs:
    case Op::kDistance:
    case Op::kHeight:
      return std::ranges::any_of(node.args, [&](NodeId arg) { return NeedsEnd(program, arg); });
    default:
      return false;
  }
}

int WindowOf(Program& program, const Node& node) {
  if (!HasWindow(node.op)) return kNone;
  const bool inside = node.op >= Op::kMean && node.op <= Op::kMedian;
  const TimeWindow window{.seconds = node.number, .inside = inside};
  const auto found = std::ranges::find(program.windows, window);
  const auto place = static_cast<int>(found - program.windows.begin());
  if (found == program.windows.end()) program.windows.push_back(window);
  return place;
}

}  // namespace

void ShareValues(Program& program) {
  for (const NodeId index : IdsOf(program.nodes)) {
    program.nodes[index].window = WindowOf(program, program.nodes[index]);
    program.nodes[index].needs_end = NeedsEnd(program, index);
  }
  std::map<std::string, int> shared;
  for (const NodeId index : IdsOf(program.nodes)) {
    Node& node = program.nodes[index];
    if (!CostsTime(node.op)) continue;
    std::vector<int> roles;
    std::string text;
    if (!Describe(program, index, roles, text) || roles.empty() || roles.size() > 2) continue;
    node.shared = shared.try_emplace(text, static_cast<int>(shared.size())).first->second;
    node.shared_roles = {roles[0], roles.size() > 1 ? roles[1] : kNone};
  }
}

}  // namespace prehend::grammar

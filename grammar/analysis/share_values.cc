// SPDX-License-Identifier: Apache-2.0
// A value is described by its expression, with roles in the order in which it names them: that of
// `speed(hand, 150 ms)` is the same in every rule, whatever the role is called there. A window is
// the same whatever is asked for in it.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "grammar/analysis/analyze_dependencies.h"

namespace prehend::grammar {
namespace {

// It looks at poses and nothing else: neither at touches, nor at other rules, nor at the begin or
// the end of an interval.
bool LooksAtPosesOnly(const Node& node) {
  const Operator& row = RowOf(node.op);
  return row.type != Type::kTruth && (row.AsksPoses() || row.asks == Asks::kNothing) &&
         !row.AsksTouchValues() && !node.needs_end && node.op != Op::kCount && node.slot == kNone;
}

// False if it depends on more than poses. Appends to the text what the value is.
bool Describe(const Program& program, NodeId index, std::vector<int>& roles, std::string& text) {
  const Node& node = program.nodes[index];
  if (!LooksAtPosesOnly(node)) return false;
  text += std::to_string(static_cast<int>(node.op)) + "," + std::to_string(node.number) +
          (node.name == kNone ? "" : "," + std::to_string(node.name)) + "(";
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

// Whether some argument has it. A condition does not always ask for all of its parts, nor a window
// that is too short for its value.
bool AnArgument(const Program& program, const Node& node, bool Node::*has) {
  return !IsLogic(node.op) && std::ranges::any_of(node.args, [&](NodeId arg) {
    return arg != kNone && program.nodes[arg].*has;
  });
}

int WindowOf(Program& program, const Node& node) {
  if (!RowOf(node.op).HasWindow()) return kNone;
  const TimeWindow window{.seconds = node.number, .inside = RowOf(node.op).in_window};
  const auto found = std::ranges::find(program.windows, window);
  const auto place = static_cast<int>(found - program.windows.begin());
  if (found == program.windows.end()) program.windows.push_back(window);
  return place;
}

}  // namespace

void ShareValues(Program& program) {
  for (Node& node : program.nodes) {  // arguments first
    const Operator& row = RowOf(node.op);
    node.window = WindowOf(program, node);
    node.needs_end =
        node.op == Op::kAtEnd || (!row.HasWindow() && AnArgument(program, node, &Node::needs_end));
    node.by_itself = row.ChangesByItself() || AnArgument(program, node, &Node::by_itself);
  }
  std::map<std::string, int> shared;
  for (const NodeId index : IdsOf(program.nodes)) {
    Node& node = program.nodes[index];
    if (!RowOf(node.op).shared) continue;
    std::vector<int> roles;
    std::string text;
    if (!Describe(program, index, roles, text) || roles.empty() || roles.size() > 2) continue;
    node.shared = shared.try_emplace(text, static_cast<int>(shared.size())).first->second;
    node.shared_roles = {roles[0], roles.size() > 1 ? roles[1] : kNone};
  }
}

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// Questions about a program that more than one room asks.
#include "grammar/program/program.h"

namespace prehend::grammar {

std::vector<NodeId> ConditionsOf(const Rule& rule) {
  std::vector<NodeId> nodes;
  if (const auto* holds = rule.If<WhileRule>()) nodes = {holds->condition, holds->until};
  if (const auto* from_to = rule.If<FromToRule>())
    nodes = {from_to->from, from_to->to, from_to->during};
  if (const auto* looks_back = rule.If<UntilSinceRule>())
    nodes = {looks_back->until, looks_back->since};
  std::erase(nodes, kNone);
  return nodes;
}

const Approach* ApproachOf(const Rule& rule) {
  const auto* part = rule.If<UntilSinceRule>();
  return part != nullptr && part->approach ? &*part->approach : nullptr;
}

std::string Law::Head() const {
  std::string text = "law " + name + "(";
  for (const Role& role : roles)
    text += (&role == &roles.front() ? "" : ", ") + role.name + ": " + role.class_name;
  return text + ")";
}

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// Needs: no absence of what may have happened out of sight, and nothing false there that must be
// known. Algorithm: which roles a rule sees by
// poses follows from its nodes and from the rules it refers to, which the schedule has before it.
// `during` gets a condition for each role; a composition gets another absence, of a hidden rule
// that holds while an entity is lost; what `known` denies of a rule gets "or it is lost". Tested by
// tests/grammar/engine/tracking_test.cc
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "grammar/analysis/analyze_dependencies.h"

namespace prehend::grammar {
namespace {

using RoleSet = unsigned;  // a bit for each role of a rule

class Sight {
 public:
  explicit Sight(Program& program) : program_(program), seen_(program.rules.size()) {}

  void Run() {
    for (const RuleId index : program_.schedule) seen_[index] = OfRule(program_.rules[index]);
    for (const RuleId index : program_.schedule) {
      const auto* from_to = program_.rules[index].If<FromToRule>();
      if (from_to != nullptr && from_to->absence) RequireOfFromTo(index);
      if (program_.rules[index].If<ComposeRule>() != nullptr) RequireOfComposition(index);
      DoubtUnseen(index);
    }
    program_.schedule.insert(program_.schedule.begin(), made_.begin(), made_.end());
  }

 private:
  RoleSet OfRule(const Rule& rule) const {
    RoleSet roles = OfNode(rule, rule.requirement);
    for (const NodeId node : ConditionsOf(rule)) roles |= OfNode(rule, node);
    if (const Approach* approach = ApproachOf(rule))
      roles |= OfNode(rule, approach->signal) | OfNode(rule, approach->motion);
    if (const auto* any = rule.If<AnyRule>(); any != nullptr && any->one != kNone)
      roles |= (1U << rule.roles.size()) - 1;  // the nearest
    for (const Reference& reference : rule.references) roles |= OfReference(reference);
    return roles;
  }

  RoleSet OfReference(const Reference& reference) const {
    RoleSet roles = 0;
    for (std::size_t i = 0; i < reference.roles.size(); ++i) {
      const bool is_named = reference.roles[i] != kNone;
      if (is_named && (seen_[reference.rule] >> i & 1U) != 0) roles |= 1U << reference.roles[i];
    }
    return roles;
  }

  RoleSet OfNode(const Rule& rule, NodeId index) const {
    if (index == kNone) return 0;
    const Node& node = program_.nodes[index];
    RoleSet roles = 0;
    for (const int role : node.roles)
      if (role != kNone && RowOf(node.op).AsksPoses()) roles |= 1U << role;
    if (node.op == Op::kOwns) roles |= 1U << node.roles[0];
    if (node.op == Op::kHolds || node.op == Op::kOwns)
      roles |= OfReference(rule.references[static_cast<std::size_t>(node.slot)]);
    if (node.op == Op::kAtBegin)
      roles |= OfNode(rule, rule.anchors[static_cast<std::size_t>(node.slot)]);
    for (const NodeId arg : node.args) roles |= OfNode(rule, arg);
    return roles;
  }

  NodeId Tracked(const Rule& rule, int role) {
    const NodeId position = program_.nodes.push_back({.op = Op::kPosition, .roles = {role, kNone}});
    const NodeId height =
        program_.nodes.push_back({.op = Op::kHeight, .args = {position, kNone, kNone, kNone}});
    const NodeId lowest = program_.nodes.push_back(
        {.op = Op::kNumber, .number = -std::numeric_limits<double>::infinity()});
    const NodeId tracked =
        program_.nodes.push_back({.op = Op::kGreater, .args = {height, lowest, kNone, kNone}});
    program_.notes.resize(program_.nodes.size());
    program_.notes[tracked] = {.text = "{" + std::to_string(role) + "} is tracked",
                               .dimension = kPlain,
                               .file = rule.file,
                               .place = rule.place};
    return tracked;
  }

  // In `known ..`, where something is denied of a rule: it is not false where it is out of sight.
  // What stands around it is made anew, as parts come before what is made of them.
  NodeId DoubtUnseen(RuleId index, NodeId node, bool known, bool denied) {
    if (node == kNone) return node;
    Node asked = program_.nodes[node];
    const bool is_edge = asked.op == Op::kBegins || asked.op == Op::kEnds;
    denied = !is_edge && asked.op != Op::kKnown && denied != (asked.op == Op::kNot);
    known = known || asked.op == Op::kKnown;
    for (NodeId& arg : asked.args) arg = DoubtUnseen(index, arg, known, denied);
    const bool is_doubted = known && denied && asked.op == Op::kHolds;
    if (!is_doubted && asked.args == program_.nodes[node].args) return node;
    NodeId made = program_.nodes.push_back(asked);
    program_.notes.resize(program_.nodes.size());
    program_.notes[made] = program_.notes[node];
    const Rule& rule = program_.rules[index];
    const RoleSet roles = is_doubted ? OfNode(rule, node) : 0;
    for (int role = 0; role < kMaxRoles; ++role) {
      if ((roles >> role & 1U) == 0) continue;
      const NodeId lost = program_.nodes.push_back(
          {.op = Op::kNot, .args = {Tracked(rule, role), kNone, kNone, kNone}});
      made = program_.nodes.push_back({.op = Op::kOr, .args = {made, lost, kNone, kNone}});
    }
    return made;
  }

  void DoubtUnseen(RuleId index) {
    Rule& rule = program_.rules[index];
    std::vector<NodeId*> asked = {&rule.requirement};
    if (auto* holds = std::get_if<WhileRule>(&rule.of_form))
      asked.insert(asked.end(), {&holds->condition, &holds->until});
    if (auto* from_to = std::get_if<FromToRule>(&rule.of_form))
      asked.insert(asked.end(), {&from_to->from, &from_to->to, &from_to->during});
    if (auto* back = std::get_if<UntilSinceRule>(&rule.of_form))
      asked.insert(asked.end(), {&back->until, &back->since});
    for (NodeId* const node : asked) *node = DoubtUnseen(index, *node, false, false);
  }

  void RequireOfFromTo(RuleId index) {
    Rule& rule = program_.rules[index];
    auto& form = rule.As<FromToRule>();
    const RoleSet roles = OfNode(rule, form.to);
    for (int role = 0; role < kMaxRoles; ++role) {
      if ((roles >> role & 1U) == 0) continue;
      const NodeId tracked = Tracked(rule, role);
      form.during = form.during == kNone
                        ? tracked
                        : program_.nodes.push_back(
                              {.op = Op::kAnd, .args = {form.during, tracked, kNone, kNone}});
    }
  }

  void RequireOfComposition(RuleId index) {
    const std::vector<ComposeRule::Absence> absences =
        program_.rules[index].As<ComposeRule>().absences;
    for (const ComposeRule::Absence& absence : absences) {
      const auto& composition = program_.rules[index].As<ComposeRule>();
      const auto slot =
          static_cast<std::size_t>(composition.parts[static_cast<std::size_t>(absence.part)]);
      const RoleSet roles = OfReference(program_.rules[index].references[slot]);
      for (int role = 0; role < kMaxRoles; ++role) {
        if ((roles >> role & 1U) == 0) continue;
        const RuleRole who = program_.rules[index].roles[static_cast<std::size_t>(role)];
        const RuleId lost = WhileLost(who, program_.rules[index]);
        Rule& rule = program_.rules[index];
        auto& whole = rule.As<ComposeRule>();
        const int part = whole.AddPart(static_cast<int>(rule.references.size()));
        whole.absences.push_back({.part = part, .left = absence.left, .right = absence.right});
        rule.references.push_back({.rule = lost, .roles = {role, kNone, kNone, kNone}});
      }
    }
  }

  // The hidden rules "it is tracked" and, as an event is false where nobody knows that it holds,
  // "not that".
  RuleId WhileLost(const RuleRole& who, const Rule& user) {
    const auto [entry, is_new] = lost_.try_emplace(who.class_name);
    if (!is_new) return entry->second;
    Rule tracked{.name = "tracked",
                 .file = user.file,
                 .place = user.place,
                 .roles = {who},
                 .hidden = true,
                 .of_form = WhileRule()};
    Rule lost = tracked;
    tracked.As<WhileRule>().condition = Tracked(tracked, 0);
    lost.name = "lost";
    const NodeId holds = program_.nodes.push_back({.op = Op::kHolds, .slot = 0});
    lost.As<WhileRule>().condition =
        program_.nodes.push_back({.op = Op::kNot, .args = {holds, kNone, kNone, kNone}});
    made_.push_back(program_.rules.push_back(std::move(tracked)));
    lost.references = {{.rule = made_.back(), .roles = {0, kNone, kNone, kNone}}};
    entry->second = program_.rules.push_back(std::move(lost));
    made_.push_back(entry->second);
    return entry->second;
  }

  Program& program_;
  IdVector<RuleId, RoleSet> seen_;  // which roles a rule knows by poses
  std::map<std::string, RuleId> lost_;
  std::vector<RuleId> made_;
};

}  // namespace

void RequireSight(Program& program) { Sight(program).Run(); }

}  // namespace prehend::grammar

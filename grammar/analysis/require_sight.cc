// SPDX-License-Identifier: Apache-2.0
// Needs: no absence of what may have happened out of sight, and nothing false there that must be
// known. Algorithm: which roles a rule sees by poses, and in which windows of time, follows from
// its nodes and from the rules it refers to, which the schedule has before it. `during` gets a
// condition for each; a composition gets another absence, of a hidden rule that holds while an
// entity is lost; what `known` denies of a rule gets "or it is lost". Tested by
// tests/grammar/engine/tracking_test.cc
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grammar/analysis/analyze_dependencies.h"

namespace prehend::grammar {
namespace {

// One in another, the outermost first: an operator over each of them, and how long it is.
using WindowChain = std::vector<std::pair<Op, double>>;
// A role of a rule that is looked at, and in which windows around the frame; none: in it.
using OneSight = std::pair<int, WindowChain>;
using Sights = std::set<OneSight>;

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
  Sights OfRule(const Rule& rule) const {
    Sights looks = OfNode(rule, rule.requirement);
    for (const NodeId node : ConditionsOf(rule)) Add(looks, rule, node);
    if (const Approach* approach = ApproachOf(rule)) {
      Add(looks, rule, approach->signal);
      Add(looks, rule, approach->motion);
    }
    if (const auto* any = rule.If<AnyRule>(); any != nullptr && any->one != kNone)
      for (std::size_t role = 0; role < rule.roles.size(); ++role)  // the nearest
        looks.insert({static_cast<int>(role), {}});
    for (const Reference& reference : rule.references) looks.merge(OfReference(reference));
    return looks;
  }

  Sights OfReference(const Reference& reference) const {
    Sights looks;
    for (const auto& [role, windows] : seen_[reference.rule]) {
      const int named = reference.roles[static_cast<std::size_t>(role)];
      if (named != kNone) looks.insert({named, windows});
    }
    return looks;
  }

  Sights OfNode(const Rule& rule, NodeId index) const {
    Sights looks;
    Add(looks, rule, index);
    return looks;
  }

  void Add(Sights& looks, const Rule& rule, NodeId index, WindowChain windows = {}) const {
    if (index == kNone) return;
    const Node& node = program_.nodes[index];
    const Operator& row = RowOf(node.op);
    if (row.HasWindow()) windows.emplace_back(row.in_window ? Op::kMean : Op::kRate, node.number);
    for (const int role : node.roles) {
      const bool looks_at = row.AsksPoses() || node.op == Op::kOwns || node.op == Op::kTouchSpeed;
      if (role != kNone && looks_at) looks.insert({role, windows});
    }
    if (node.op == Op::kHolds || node.op == Op::kOwns)
      looks.merge(OfReference(rule.references[static_cast<std::size_t>(node.slot)]));
    if (node.op == Op::kAtBegin)
      Add(looks, rule, rule.anchors[static_cast<std::size_t>(node.slot)], windows);
    for (const NodeId arg : node.args) Add(looks, rule, arg, windows);
  }

  NodeId Tracked(const Rule& rule, const OneSight& look) {
    const auto& [role, windows] = look;
    const NodeId position = program_.nodes.push_back({.op = Op::kPosition, .roles = {role, kNone}});
    NodeId height =
        program_.nodes.push_back({.op = Op::kHeight, .args = {position, kNone, kNone, kNone}});
    for (auto window = windows.rbegin(); window != windows.rend(); ++window)
      height = program_.nodes.push_back(
          {.op = window->first, .args = {height, kNone, kNone, kNone}, .number = window->second});
    const NodeId lowest = program_.nodes.push_back(
        {.op = Op::kNumber, .number = -std::numeric_limits<double>::infinity()});
    const NodeId tracked =
        program_.nodes.push_back({.op = Op::kGreater, .args = {height, lowest, kNone, kNone}});
    program_.notes.resize(program_.nodes.size());
    program_.notes[tracked] = {.text = "{" + std::to_string(role) + "} is tracked" +
                                       (windows.empty() ? "" : " in the window around"),
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
    for (const OneSight& look : is_doubted ? OfNode(rule, node) : Sights()) {
      const NodeId lost = program_.nodes.push_back(
          {.op = Op::kNot, .args = {Tracked(rule, look), kNone, kNone, kNone}});
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
    for (const OneSight& look : OfNode(rule, form.to)) {
      const NodeId tracked = Tracked(rule, look);
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
      for (const auto& [role, windows] : OfReference(program_.rules[index].references[slot])) {
        const RuleRole who = program_.rules[index].roles[static_cast<std::size_t>(role)];
        const RuleId lost = WhileLost(who, windows, program_.rules[index]);
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
  RuleId WhileLost(const RuleRole& who, const WindowChain& windows, const Rule& user) {
    const auto [entry, is_new] = lost_.try_emplace({who.class_name, windows});
    if (!is_new) return entry->second;
    Rule tracked{.name = "tracked",
                 .file = user.file,
                 .place = user.place,
                 .roles = {who},
                 .hidden = true,
                 .of_form = WhileRule()};
    Rule lost = tracked;
    tracked.As<WhileRule>().condition = Tracked(tracked, {0, windows});
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
  IdVector<RuleId, Sights> seen_;  // which roles a rule knows by poses
  std::map<std::pair<std::string, WindowChain>, RuleId> lost_;
  std::vector<RuleId> made_;
};

}  // namespace

void RequireSight(Program& program) { Sight(program).Run(); }

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// Rules in the order of the schedule: what a rule asks about is known before it. A condition is
// false, true or either, when facts that there are not count as what their signals are without
// them; of what is false, the missing fact is kept.
#include "grammar/never_recognised.h"

#include <algorithm>
#include <optional>

#include "grammar/base/three_valued.h"

namespace prehend::grammar {
namespace {

struct Judged {
  Kleene truth = Kleene::kUnknown;
  std::string_view fact;  ///< why, if it is not unknown
};

Judged And(const Judged& a, const Judged& b) { return a.truth <= b.truth ? a : b; }
Judged Or(const Judged& a, const Judged& b) { return a.truth >= b.truth ? a : b; }

class FactsJudge {
 public:
  FactsJudge(const Program& program, const FactsOfEpisode& facts)
      : program_(program), facts_(facts), never_(program.rules.size()) {
    for (const RuleId rule : program.schedule) never_[rule] = NeverOf(program.rules[rule]);
  }

  /// Why no interval of the rule ever begins; empty if one may.
  std::string_view Never(RuleId rule) const { return never_[rule]; }

 private:
  std::string_view NeverOf(const Rule& rule) const {
    std::string_view why = NeverOfForm(rule);
    const auto ask = [&](std::string_view other) {
      if (why.empty()) why = other;
    };
    if (rule.requirement != kNone) ask(WhyFalse(rule, rule.requirement));
    if (rule.confirmed_by != kNone) ask(NeverOfReference(rule, rule.confirmed_by));
    return why;
  }

  std::string_view NeverOfForm(const Rule& rule) const {
    std::string_view why;
    const auto ask = [&](std::string_view other) {
      if (why.empty()) why = other;
    };
    switch (rule.form()) {
      case Form::kTouching:
        return facts_.touches ? "" : "touches";
      case Form::kAny:
        return NeverOfReference(rule, 0);
      case Form::kWhile:
        return WhyFalse(rule, rule.As<WhileRule>().condition);
      case Form::kFromTo: {
        const FromToRule& part = rule.As<FromToRule>();
        ask(WhyFalse(rule, part.from));
        if (part.during != kNone) ask(WhyFalse(rule, part.during));
        if (!part.absence && (part.or_drop || part.within_s >= 0)) ask(WhyFalse(rule, part.to));
        return why;
      }
      case Form::kUntilSince:
        ask(WhyFalse(rule, rule.As<UntilSinceRule>().until));
        ask(WhyFalse(rule, rule.As<UntilSinceRule>().since));
        return why;
      case Form::kRestOf:
        return NeverOfReference(rule, rule.As<RestOfRule>().whole);
      case Form::kCompose:
        return NeverOfParts(rule);
    }
    return why;
  }

  // All parts must be there, or of a repetition one of them.
  std::string_view NeverOfParts(const Rule& rule) const {
    const auto& composition = rule.As<ComposeRule>();
    std::string_view some;
    for (int part = 0; part < composition.count; ++part) {
      std::string_view why;
      for (const int slot : composition.ChoicesFor(part)) {
        why = NeverOfReference(rule, slot);
        if (why.empty()) break;
      }
      if (why.empty() == (composition.at_least > 0)) return why;
      if (some.empty()) some = why;
    }
    return some;
  }

  std::string_view NeverOfReference(const Rule& rule, int slot) const {
    return never_[rule.references[static_cast<std::size_t>(slot)].rule];
  }

  std::string_view WhyFalse(const Rule& rule, NodeId node) const {
    const Judged judged = Truth(rule, node);
    return judged.truth == Kleene::kFalse ? judged.fact : "";
  }

  Judged Truth(const Rule& rule, NodeId index) const {
    const Node& node = program_.nodes[index];
    if (node.op == Op::kAnd) return And(Truth(rule, node.args[0]), Truth(rule, node.args[1]));
    if (node.op == Op::kOr) return Or(Truth(rule, node.args[0]), Truth(rule, node.args[1]));
    if (IsComparison(node.op)) return Compared(node);
    if (IsLogic(node.op)) {
      const Judged judged = Truth(rule, node.args[0]);
      if (node.op == Op::kNot) return {Not(judged.truth), judged.fact};
      // What is always true begins with the episode.
      return judged.truth == Kleene::kFalse ? judged : Judged{};
    }
    const std::string_view why =
        node.op == Op::kHolds ? NeverOfReference(rule, node.slot) : Lacks(RowOf(node.op).needs);
    return why.empty() ? Judged{} : Judged{Kleene::kFalse, why};
  }

  /// The fact, if there is none in the episode.
  std::string_view Lacks(Fact fact) const {
    switch (fact) {
      case Fact::kNoFact:
        return "";
      case Fact::kTouches:
        return facts_.touches ? "" : "touches";
      case Fact::kSensorSets:
        return facts_.sensor_sets ? "" : "sensor sets";
      case Fact::kForces:
        return facts_.forces ? "" : "forces";
      case Fact::kOrientations:
        return facts_.orientations ? "" : "orientations";
      case Fact::kGrips:
        return facts_.grips ? "" : "closed grips";
      case Fact::kGazes:
        return facts_.gazes ? "" : "gazes";
    }
    return "";
  }

  struct Missing {
    double value = 0;  ///< what the signal is where there is no such fact
    std::string_view fact;
  };

  std::optional<Missing> MissingOf(const Node& node) const {
    if (node.op == Op::kNumber) return Missing{node.number, ""};
    const Operator& row = RowOf(node.op);
    if (Lacks(row.needs).empty()) return std::nullopt;
    const bool counts_sets = row.needs == Fact::kSensorSets && !facts_.touches;
    return Missing{row.without, counts_sets ? "touches" : Lacks(row.needs)};
  }

  Judged Compared(const Node& node) const {
    const auto left = MissingOf(program_.nodes[node.args[0]]);
    const auto right = MissingOf(program_.nodes[node.args[1]]);
    if (!left || !right) return {};
    return {Known(Compares(node.op, left->value, right->value)),
            left->fact.empty() ? right->fact : left->fact};
  }

  const Program& program_;
  const FactsOfEpisode& facts_;
  IdVector<RuleId, std::string_view> never_;
};

}  // namespace

/// Less is an open hand, whose number was rounded.
constexpr double kClosing = 0.001;

void FactsOfEpisode::Add(const Frame& frame, const EntityTable& entities) {
  touches = touches || !frame.touches.empty();
  for (const Touch& touch : frame.touches) {
    sensor_sets = sensor_sets || touch.sensor_sets != 0;
    forces = forces || touch.normal_force_n != 0;
  }
  for (const HandSample& hand : frame.hands) grips = grips || hand.trigger > kClosing;
  for (const EntitySample& look : frame.entities) gazes = gazes || look.gazes_at != kNoEntity;
  for (std::size_t i = 0; i < frame.entities.size() && !orientations; ++i) {
    const auto& classes = entities.entities[i].classes;
    orientations = frame.entities[i].q_WB.vec() != Eigen::Vector3d(0, 0, 0) &&
                   std::ranges::find(classes, "Fixed") == classes.end();
  }
}

std::vector<NeverRecognised> FindNeverRecognised(const Program& program,
                                                 const FactsOfEpisode& facts) {
  const FactsJudge judge(program, facts);
  std::vector<NeverRecognised> never;
  for (const RuleId index : IdsOf(program.rules)) {
    const Rule& rule = program.rules[index];
    const std::string_view why = judge.Never(index);
    if (rule.printed && !why.empty()) never.push_back({rule.name, rule.file, rule.place, why});
  }
  return never;
}

}  // namespace prehend::grammar

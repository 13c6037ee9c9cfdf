// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/coverage/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "grammar/contents.h"
#include "harness/show/explain/clauses.h"
#include "harness/show/explain/query.h"

namespace prehend::measure {
namespace {

using grammar::CandidateOutcome;
using grammar::FrameNumber;
using grammar::InstanceId;
using grammar::kNone;
using grammar::NodeId;
using grammar::Op;
using grammar::Rule;
using show::Viewpoint;
/// File, line, column, and of a clause about whole intervals what it says.
using Place = std::tuple<std::string, int, int, std::string>;
constexpr double kNoLimit = -1;
const grammar::CandidateLog kNoOutcomes;
namespace fate = grammar::fate;

/// In the order of grammar::Fate.
constexpr std::array kBecame = {"interval", "too short",   "too long",     "too few",
                                "refused",  "unconfirmed", "dropped",      "too late",
                                "it came",  "unfinished",  "nothing back", "walked back"};
static_assert(kBecame.size() == std::variant_size_v<grammar::Fate>);

/// "rise(object) >= lift_rise" of "rise({1}) >= lift_rise".
std::string WithRoles(const std::string& text, const Rule& rule) {
  std::string named;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t role = i + 2 < text.size() && text[i] == '{' && text[i + 2] == '}'
                                 ? static_cast<std::size_t>(text[i + 1] - '0')
                                 : rule.roles.size();
    named += role < rule.roles.size() ? rule.roles[role].name : std::string(1, text[i]);
    if (role < rule.roles.size()) i += 2;
  }
  return named;
}

class Collector {
 public:
  explicit Collector(grammar::ReplayMonitor& past) : past_(past), clauses_(past) {}

  Coverage Collect() {
    coverage_.grammar = GrammarName(past_.program());
    for (const grammar::RuleId id : grammar::IdsOf(past_.program().rules)) {
      rule_ = &past_.program().rules[id];
      if (id == grammar::kTouchingRule) continue;
      List();
      CoveredRule covered{.name = rule_->name,
                          .file = rule_->file,
                          .line = rule_->place.line,
                          .column = rule_->place.column,
                          .is_event = rule_->printed};
      for (const InstanceId instance : past_.InstancesOf(id)) {
        ++covered.bound;
        for (const CandidateOutcome& outcome : past_.OutcomesOf(instance)) Count(outcome, covered);
        Look(instance);
      }
      // What the compiler made of `one .. per` has the clauses of the rule, which has the
      // intervals.
      if (!rule_->hidden) coverage_.rules.push_back(std::move(covered));
    }
    for (auto& [place, clause] : by_place_) {
      if (!clause.seen.empty()) clause.all = clause.seen.at(0);
      coverage_.clauses.push_back(std::move(clause));
    }
    return std::move(coverage_);
  }

 private:
  /// The clause of a node; null for what the compiler made.
  Clause* Find(NodeId node) {
    const grammar::NodeNote& note = show::NoteOf(past_.program(), node);
    const auto found = by_place_.find({note.file, note.place.line, note.place.column, ""});
    return found == by_place_.end() ? nullptr : &found->second;
  }

  /// A clause about whole intervals; it stands where its rule does. With a limit in seconds it is a
  /// threshold.
  Clause& Whole(const std::string& part, double limit_s, std::string text = {}) {
    const bool is_threshold = limit_s != kNoLimit;
    if (is_threshold) text = show::QuantityText(limit_s, grammar::kSeconds);
    const auto& [line, column] = rule_->place;
    Clause& clause = by_place_[{rule_->file, line, column, part + text}];
    if (clause.rule.empty())
      clause = {.file = rule_->file,
                .line = line,
                .column = column,
                .rule = rule_->name,
                .part = part,
                .text = std::move(text),
                .unit = is_threshold ? "s" : "",
                .is_threshold = is_threshold};
    return clause;
  }

  /// What is never evaluated is a clause, too.
  void List(NodeId node, const char* part) {
    if (node == kNone) return;
    const grammar::Node& n = past_.program().nodes[node];
    const bool is_logic = n.op == Op::kAnd || n.op == Op::kOr || n.op == Op::kNot ||
                          n.op == Op::kKnown || IsOpenEdge(n);
    if (is_logic) {
      for (const NodeId arg : n.args) List(arg, part);
      return;
    }
    const grammar::NodeNote& note = show::NoteOf(past_.program(), node);
    if (note.text.empty() || note.place.line == 0) return;
    const auto& [line, column] = note.place;
    Clause& clause = by_place_[{note.file, line, column, ""}];
    if (clause.rule.empty())
      clause = {.file = note.file,
                .line = line,
                .column = column,
                .rule = rule_->name,
                .part = part,
                .text = WithRoles(note.text, *rule_)};
    if (!IsComparison(n.op) && !show::IsRegion(n.op)) return;
    clause.is_threshold = true;
    const grammar::Dimension dimension =
        IsComparison(n.op) ? show::NoteOf(past_.program(), n.args[0]).dimension : grammar::kMetres;
    if (dimension != grammar::kPlain) clause.unit = grammar::DimensionText(dimension);
  }
  void List() {
    if (const auto* rule = rule_->If<grammar::WhileRule>()) {
      if (rule->at_least == 0) List(rule->condition, "while");  // else the compiler makes it
      List(rule->until, "until");
    } else if (const auto* from_to = rule_->If<grammar::FromToRule>()) {
      List(from_to->from, "from");
      List(from_to->to, from_to->absence ? "without" : "to");
      List(from_to->during, "during");
    } else if (const auto* back = rule_->If<grammar::UntilSinceRule>()) {
      List(back->until, "until");
      List(back->since, "since");
    }
    List(rule_->requirement, "requires");
    LookAtWhole(kNone, kNoOutcomes);
  }
  /// A moment of more than one interval: what is in it decides.
  bool IsOpenEdge(const grammar::Node& n) const {
    return (n.op == Op::kBegins || n.op == Op::kEnds) &&
           past_.program().nodes[n.args[0]].op != Op::kHolds;
  }

  void Count(const CandidateOutcome& outcome, CoveredRule& covered) {
    ++covered.begun;
    ++covered.became[kBecame[outcome.fate.index()]];
    covered.open_end += outcome.IsInterval() && outcome.span.open_end;
    if (outcome.IsInterval() && covered.episodes.empty()) covered.episodes.push_back(0);
  }

  void Look(InstanceId instance) {
    const grammar::CandidateLog& outcomes = past_.OutcomesOf(instance);
    if (rule_->If<grammar::WhileRule>() != nullptr) LookAtWhile(instance, outcomes);
    if (rule_->If<grammar::FromToRule>() != nullptr) LookAtFromTo(instance, outcomes);
    if (rule_->If<grammar::UntilSinceRule>() != nullptr) LookBack(instance, outcomes);
    LookAtWhole(instance, outcomes);
    if (rule_->requirement == kNone) return;
    for (const CandidateOutcome& outcome : outcomes) {
      if (!WasRequired(outcome)) continue;
      const FrameNumber last = std::min(outcome.span.end.frame, past_.frames() - 1);
      Decide(rule_->requirement,
             {.instance = instance, .frame = last, .begin = outcome.span.begin.frame, .end = last});
    }
  }
  /// What was lost before was not asked for what the rule requires.
  static bool WasRequired(const CandidateOutcome& outcome) {
    return outcome.IsInterval() || outcome.If<fate::Refused>() != nullptr ||
           outcome.If<fate::Unconfirmed>() != nullptr;
  }

  void LookAtWhile(InstanceId instance, const grammar::CandidateLog& outcomes) {
    const auto& rule = rule_->As<grammar::WhileRule>();
    const bool stays = rule.until != kNone;
    FrameNumber next = 0, gap_from = 0;
    const auto outside = [&](FrameNumber end) {
      for (; next < end; ++next)
        Decide(rule.condition, {.instance = instance, .frame = next, .begin = next});
    };
    for (const CandidateOutcome& outcome : outcomes) {
      const FrameNumber begin = outcome.span.begin.frame, end = outcome.span.end.frame;
      if (rule.bridging_s > 0) Bridge(rule, instance, outcome, gap_from);
      if (rule.at_least > 0) continue;
      outside(begin + 1);
      Turn(rule.condition, {.instance = instance, .frame = begin, .begin = begin}, true);
      for (; stays && next < std::min(end + 1, past_.frames()); ++next)
        Decide(rule.until, {.instance = instance, .frame = next, .begin = begin});
      if (end < past_.frames())
        Turn(stays ? rule.until : rule.condition,
             {.instance = instance, .frame = end, .begin = begin}, stays);
    }
    if (rule.at_least == 0) outside(past_.frames());
  }

  static const char* GapName(const grammar::WhileRule& rule) {
    return rule.at_least > 0 ? "gap at most" : "bridging";
  }
  /// Gaps within an interval were bridged, those between two were not.
  void Bridge(const grammar::WhileRule& rule, InstanceId instance, const CandidateOutcome& outcome,
              FrameNumber& gap_from) {
    Clause& bridging = Whole(GapName(rule), rule.bridging_s);
    const auto add = [&](bool bridged, FrameNumber from, FrameNumber to) {
      const double gap_s = clauses_.Seconds(past_.TickOf(to) - past_.TickOf(from));
      bridging.seen[0].Add(bridged, std::abs(gap_s - rule.bridging_s));
    };
    const auto [begin, end] = std::pair(outcome.span.begin.frame, outcome.span.end.frame);
    if (gap_from > 0) add(false, gap_from, begin);
    gap_from = end;
    std::optional<FrameNumber> lost;
    for (FrameNumber frame = begin; frame < std::min(end, past_.frames()); ++frame) {
      const Viewpoint at{.instance = instance, .frame = frame, .begin = begin};
      const bool closed = rule.until != kNone && past_.Truth(rule.until, at);
      const bool holds =
          !closed && ((rule.until != kNone && !lost) || past_.Truth(rule.condition, at));
      if (holds && lost) add(true, *lost, frame);
      lost = holds ? std::nullopt : lost ? lost : std::optional(frame);
    }
  }

  void LookAtFromTo(InstanceId instance, const grammar::CandidateLog& outcomes) {
    const auto& rule = rule_->As<grammar::FromToRule>();
    FrameNumber next = 0;
    const auto outside = [&](FrameNumber end) {
      for (; next < end; ++next)
        Decide(rule.from, {.instance = instance, .frame = next, .begin = next});
    };
    for (const CandidateOutcome& outcome : outcomes) {
      const FrameNumber begin = outcome.span.begin.frame;
      const auto* dropped = outcome.If<fate::Dropped>();
      const FrameNumber end = dropped != nullptr ? dropped->at : outcome.span.end.frame;
      outside(begin + 1);
      Viewpoint at{.instance = instance, .frame = begin, .begin = begin};
      Turn(rule.from, at, true);
      for (at.frame = begin; at.frame < std::min(end + 1, past_.frames()); ++at.frame) {
        if (at.frame > begin) Decide(rule.to, at);
        if (rule.during != kNone) Decide(rule.during, at);
      }
      next = std::max(next, end);
      at.frame = end;
      if (end >= past_.frames()) continue;
      const bool closed = past_.Truth(rule.to, at);
      if (closed || rule.during != kNone) Turn(closed ? rule.to : rule.during, at, closed);
    }
    outside(past_.frames());
  }

  void LookBack(InstanceId instance, const grammar::CandidateLog& outcomes) {
    const auto& rule = rule_->As<grammar::UntilSinceRule>();
    for (FrameNumber frame = 0; frame < past_.frames(); ++frame)
      Decide(rule.until, {.instance = instance, .frame = frame});
    for (const CandidateOutcome& outcome : outcomes) {
      const FrameNumber end = outcome.span.end.frame;
      const bool is_empty = outcome.If<fate::NothingBack>() != nullptr;
      const FrameNumber first = is_empty ? end - 1 : std::min(outcome.span.begin.frame, end) - 1;
      for (FrameNumber frame = std::max<FrameNumber>(0, first); frame < end; ++frame)
        Decide(rule.since, {.instance = instance, .frame = frame, .end = end});
      Turn(rule.until, {.instance = instance, .frame = end}, true, true);
    }
  }

  void LookAtStops(const grammar::UntilSinceRule& rule, const grammar::CandidateLog& outcomes) {
    using Stop = grammar::WalkBack::Stop;
    const auto stops = [&](const char* part, const char* text, double limit_s, Stop stop) {
      Clause& clause = Whole(part, limit_s, text);
      for (const CandidateOutcome& outcome : outcomes) {
        if (outcome.If<fate::NothingBack>() == nullptr)
          clause.seen[0].Add(outcome.walk.stop != stop);
      }
    };
    stops("at most .. back", "", rule.back_s, Stop::kTooFarBack);
    if (!rule.approach) return;
    stops("approaching", "receding at most", kNoLimit, Stop::kReceding);
    if (rule.approach->idle_s >= 0) stops("slower than", "", rule.approach->idle_s, Stop::kIdle);
  }

  void CountRepeats(int at_least, const grammar::CandidateLog& outcomes) {
    Clause& count = Whole("at least", kNoLimit, std::to_string(at_least));
    count.is_threshold = true;
    for (const CandidateOutcome& outcome : outcomes) {
      const auto* few = outcome.If<fate::TooFew>();
      count.seen[0].Add(few == nullptr, few == nullptr ? 0 : at_least - few->found);
    }
  }
  /// Pairs of intervals of the parts, as they lie to each other.
  void LookAtParts(InstanceId instance, const grammar::CandidateLog& outcomes) {
    const auto& rule = rule_->As<grammar::ComposeRule>();
    const auto name = [&](int part) {
      return past_.program().rules[rule_->references[rule.parts[part]].rule].name;
    };
    if (rule.at_least > 0) CountRepeats(rule.at_least, outcomes);
    for (const grammar::ComposeRule::Clause& clause : rule.clauses) {
      const grammar::Relations relations =
          clause.In([this](double seconds) { return past_.AtMostTicks(seconds); });
      for (std::size_t one = 0; one < grammar::kAllenNames.size(); ++one) {
        if ((clause.relations >> one & 1) == 0) continue;
        grammar::Relations only = relations;
        only.any = grammar::Bit(static_cast<grammar::Allen>(one));
        Clause& covered = Whole("where", kNoLimit,
                                fmt::format("{} {} {}", name(clause.left),
                                            grammar::kAllenNames[one], name(clause.right)));
        if (instance == kNone) continue;
        ForEachPair(instance, rule, clause, [&](const auto& left, const auto& right) {
          if (only.Fit(left, right) || !relations.Fit(left, right))
            covered.seen[0].Add(only.Fit(left, right));
        });
      }
    }
  }
  template <typename Use>
  void ForEachPair(InstanceId instance, const grammar::ComposeRule& rule,
                   const grammar::ComposeRule::Clause& clause, const Use& use) {
    const auto intervals = [&](int part) {
      std::vector<grammar::Interval> all;
      for (const int slot : rule.ChoicesFor(part)) {
        for (const CandidateOutcome& one : past_.OutcomesOf(past_.Referred(instance, slot)))
          if (one.IsInterval()) all.push_back({one.span.begin.tick, one.span.end.tick});
      }
      return all;
    };
    const auto rights = intervals(clause.right);
    for (const grammar::Interval& left : intervals(clause.left))
      for (const grammar::Interval& right : rights) use(left, right);
  }

  void LookAtWhole(InstanceId instance, const grammar::CandidateLog& outcomes) {
    if (const auto* rule = rule_->If<grammar::UntilSinceRule>()) LookAtStops(*rule, outcomes);
    if (rule_->If<grammar::ComposeRule>() != nullptr) LookAtParts(instance, outcomes);
    const auto length_s = [&](const CandidateOutcome& one) {
      return clauses_.Seconds(one.span.end.tick - one.span.begin.tick);
    };
    const auto lasts = [&]<typename Failed>(const char* part, double limit_s, Failed) {
      Clause& clause = Whole(part, limit_s);
      for (const CandidateOutcome& one : outcomes) {
        const bool fails = one.If<Failed>() != nullptr;
        if (fails || one.IsInterval())
          clause.seen[0].Add(!fails, std::abs(length_s(one) - limit_s));
      }
    };
    if (const auto* rule = rule_->If<grammar::WhileRule>()) {
      if (rule->at_least > 0) CountRepeats(rule->at_least, outcomes);
      if (rule->bridging_s > 0) Whole(GapName(*rule), rule->bridging_s);
    }
    if (rule_->lasting_s > 0) lasts("lasting", rule_->lasting_s, fate::TooShort{});
    if (rule_->lasting_most_s >= 0) lasts("lasting .. to", rule_->lasting_most_s, fate::TooLong{});
    if (const auto* rule = rule_->If<grammar::FromToRule>(); rule != nullptr && rule->within_s >= 0)
      rule->absence ? lasts("within", rule->within_s, fate::Came{})
                    : lasts("within", rule->within_s, fate::TooLate{});
    if (rule_->confirmed_by == kNone) return;
    Clause& confirmed =
        Whole("confirmed by", kNoLimit,
              past_.program().rules[rule_->references[rule_->confirmed_by].rule].name);
    for (const CandidateOutcome& one : outcomes) {
      if (one.IsInterval() || one.If<fate::Unconfirmed>() != nullptr)
        confirmed.seen[0].Add(one.IsInterval());
    }
  }

  /// Goes to each clause on which the node's value hangs at the frame.
  void Decide(NodeId node, const Viewpoint& at) {
    const grammar::Node& n = past_.program().nodes[node];
    if (n.op == Op::kAnd || n.op == Op::kOr) {
      // The other one is as it has to be for this one to decide.
      const bool open = n.op == Op::kAnd;
      const bool left = past_.Is(open, n.args[0], at), right = past_.Is(open, n.args[1], at);
      if (right) Decide(n.args[0], at);
      if (left) Decide(n.args[1], at);
      return;
    }
    if (n.op == Op::kNot || n.op == Op::kKnown || IsOpenEdge(n)) return Decide(n.args[0], at);
    const bool truth = past_.Truth(node, at);
    if (!truth && !past_.Is(false, node, at)) return;
    Clause* clause = Find(node);
    if (clause == nullptr) return;
    const auto measured = clause->is_threshold ? clauses_.Measure(node, at) : std::nullopt;
    clause->seen[0].Add(truth,
                        measured ? std::abs(measured->value - measured->limit) : Sides::kFar);
  }

  /// The clauses that became so at this frame began an interval, or ended it.
  void Turn(NodeId node, const Viewpoint& at, bool truth, bool end = false) {
    if (node == kNone || at.frame >= past_.frames()) return;
    Viewpoint before = at;
    --before.frame;
    for (const show::Clauses::Clause& one : clauses_.Split(node, at, truth)) {
      if (!past_.Is(one.truth, one.node, at)) continue;
      if (before.frame >= 0 && past_.Is(one.truth, one.node, before)) continue;
      const grammar::Node& n = past_.program().nodes[one.node];
      if (IsOpenEdge(n)) Turn(n.args[0], at, n.op == Op::kBegins, end);
      Clause* clause = Find(one.node);
      if (clause == nullptr) continue;
      const bool ends = end || at.begin != at.frame;
      ++(ends ? clause->ended : clause->began);
    }
  }

  grammar::ReplayMonitor& past_;
  show::Clauses clauses_;
  const Rule* rule_ = nullptr;
  Coverage coverage_;
  std::map<Place, Clause> by_place_;
};

}  // namespace

void Sides::Add(bool truth, double distance, std::int64_t times) {
  decided[truth] += times;
  if (distance < nearest[truth]) nearest[truth] = distance;
}

Coverage CoverageOf(grammar::ReplayMonitor& past) { return Collector(past).Collect(); }

}  // namespace prehend::measure

// SPDX-License-Identifier: Apache-2.0
// Runs that were given up, and the choice of what an event is missing for.
#include "harness/show/explain/why_missing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "harness/show/explain/query.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {

namespace fate = grammar::fate;
using grammar::CandidateOutcome;
using grammar::FrameNumber;
using grammar::FromToRule;
using grammar::InstanceId;
using grammar::kNone;
using grammar::Rule;
using grammar::Tick;
using grammar::UntilSinceRule;
using Mark = Reason::Mark;

namespace {

constexpr double kAround_s = 0.25;  // a person's or a golden's idea of a moment is not exact

// The innermost clause that failed first; one that can't hold only where no other failed.
const Reason* FirstFailure(const Reasons& reasons) {
  const Reason* first = nullptr;
  for (const Reason& reason : reasons) {
    if (reason.mark != Mark::kFailed) continue;
    if (first == nullptr || (first->impossible && !reason.impossible)) first = &reason;
  }
  const Reason* inner = first == nullptr ? nullptr : FirstFailure(first->because);
  return inner != nullptr ? inner : first;
}

Reasons OnlyFailed(std::string what, std::string how) {
  return {{.mark = Mark::kFailed, .what = std::move(what), .how = std::move(how)}};
}

}  // namespace

MissingReasons::Window MissingReasons::Around(FrameNumber frame) {
  const Tick tick = past_.TickOf(frame);
  const Tick around = past_.AtMostTicks(kAround_s);
  return {past_.FrameAt(tick - around), past_.FrameAt(tick + around), frame};
}

MissingReasons::Window MissingReasons::Within(const Window& window, FrameNumber frame) {
  const Window around = Around(frame);
  if (!window.at) return around;
  return {std::max(around.first, window.first), std::min(around.last, window.last), frame};
}

WhyMissing MissingReasons::Explain(const std::vector<InstanceId>& instances,
                                   std::optional<FrameNumber> at) {
  const Window window = at ? Around(*at) : Whole();
  std::optional<Cause> worst;
  PREHEND_CHECK(!instances.empty());
  InstanceId nearest = instances.front();
  for (const InstanceId instance : instances) {
    Cause cause = OfInstance(instance, window, 0);
    if (worst && cause.closeness <= worst->closeness) continue;
    worst = std::move(cause);
    nearest = instance;
  }
  const Rule& rule = past_.RuleOf(nearest);
  WhyMissing why{.event = Label(past_, nearest),
                 .where = Source(rule.file, rule.place),
                 .reasons = std::move(worst->reasons)};
  if (at) why.expected_at = past_.TickOf(*at);
  if (const Reason* failure = FirstFailure(why.reasons)) {
    why.because = failure->what + (failure->how.empty() ? "" : ": " + failure->how);
    if (!failure->because.empty() && failure->because.front().mark == Mark::kTurned) {
      why.because += ": " + failure->because.front().what + " " + failure->because.front().how;
    }
    if (failure->tick && failure->reading)
      why.because += ", at " + At(*failure->tick, past_.entity_table().ticks_per_second);
  }
  for (const CandidateOutcome& outcome : past_.OutcomesOf(nearest)) {
    if (!outcome.IsInterval()) continue;
    why.nearest.push_back({.event = why.event,
                           .where = why.where,
                           .interval = {outcome.span.begin.tick, outcome.span.end.tick},
                           .decided = outcome.decided,
                           .open_end = outcome.span.open_end});
  }
  return why;
}

MissingReasons::Cause MissingReasons::OfInstance(InstanceId instance, const Window& window,
                                                 int depth) {
  if (instance == kNone || depth >= kMaxDepth) return {};
  if (const CandidateOutcome* run = NearestRun(instance, window))
    return OfRun(*run, depth, window.at ? grammar::kNever : window.last);
  return OfForm(instance, window, depth);
}

const grammar::CandidateLog& MissingReasons::RunsOf(InstanceId instance) {
  const grammar::CandidateLog& noted = past_.OutcomesOf(instance);
  const auto* rule = past_.RuleOf(instance).If<UntilSinceRule>();
  if (rule == nullptr) return noted;
  const auto [found, is_new] = runs_until_.try_emplace(instance, noted);
  grammar::CandidateLog& runs = found->second;
  if (!is_new) return runs;
  std::set<FrameNumber> ends;
  for (const CandidateOutcome& outcome : noted) ends.insert(outcome.span.end.frame);
  for (FrameNumber frame = 0; frame < past_.frames(); ++frame) {
    if (ends.contains(frame) || !past_.Truth(rule->until, {.instance = instance, .frame = frame}))
      continue;
    const grammar::Moment end{frame, past_.TickOf(frame)};
    runs.push_back({.fate = fate::NothingBack{},
                    .instance = instance,
                    .span = {end, end},
                    .decided = end.tick});
  }
  std::ranges::stable_sort(runs, {},
                           [](const CandidateOutcome& outcome) { return outcome.span.end.tick; });
  return runs;
}

// Of the runs within the window that came to nothing, the one that was nearest to being an
// interval.
const CandidateOutcome* MissingReasons::NearestRun(InstanceId instance, const Window& window) {
  const CandidateOutcome* nearest = nullptr;
  double closeness = 0;
  for (const CandidateOutcome& outcome : RunsOf(instance)) {
    const bool within =
        outcome.span.begin.frame <= window.last && outcome.span.end.frame >= window.first;
    if (outcome.IsInterval() || !within) continue;
    const bool covers =
        window.at && outcome.span.begin.frame <= *window.at && *window.at < outcome.span.end.frame;
    const double here = RunCloseness(outcome) + (covers ? 1 : 0);
    if (nearest != nullptr && here <= closeness) continue;
    nearest = &outcome;
    closeness = here;
  }
  return nearest;
}

double MissingReasons::RunCloseness(const CandidateOutcome& outcome) {
  const Rule& rule = past_.RuleOf(outcome.instance);
  const FrameNumber last = std::min(outcome.span.end.frame, past_.frames() - 1);
  const double lasted_s = truth::SecondsOf(outcome.span.end.tick - outcome.span.begin.tick,
                                           past_.entity_table().ticks_per_second);
  if (outcome.If<fate::TooShort>() != nullptr) return 1 + 0.5 * lasted_s / rule.lasting_s;
  if (const auto* few = outcome.If<fate::TooFew>())
    return 1 + 0.9 * few->found / rule.As<grammar::WhileRule>().at_least;
  if (outcome.If<fate::Refused>() != nullptr) {
    const Viewpoint at{.instance = outcome.instance,
                       .frame = last,
                       .begin = outcome.span.begin.frame,
                       .end = last};
    return 1 + 0.9 * clauses_.Nearness(rule.requirement, at, true);
  }
  if (outcome.If<fate::Unconfirmed>() != nullptr) return 1.9;
  if (outcome.If<fate::NothingBack>() == nullptr) return 1.5;
  if (outcome.span.end.frame == 0) return 0.9;  // nor could there be anything
  const Viewpoint before{.instance = outcome.instance, .frame = last - 1, .end = last};
  return 1 + 0.5 * clauses_.Nearness(rule.As<UntilSinceRule>().since, before, true);
}

std::string MissingReasons::Awaited(InstanceId instance) {
  const FromToRule& rule = past_.RuleOf(instance).As<FromToRule>();
  return (rule.absence ? "without " : "to ") + ClauseText(past_, instance, rule.to);
}

// When what was waited for came after all, for the first time.
std::string MissingReasons::HowLate(const CandidateOutcome& outcome) {
  const FromToRule& rule = past_.RuleOf(outcome.instance).As<FromToRule>();
  const Tick per_second = past_.entity_table().ticks_per_second;
  const Tick within = past_.AtMostTicks(rule.within_s);
  for (FrameNumber frame = outcome.span.begin.frame + 1; frame < past_.frames(); ++frame) {
    const Tick late = past_.TickOf(frame) - outcome.span.begin.tick - within;
    if (late <= 0 || !past_.Truth(rule.to, {.instance = outcome.instance,
                                            .frame = frame,
                                            .begin = outcome.span.begin.frame}))
      continue;
    return "but " + Duration(late, per_second) + " later, at " + clauses_.Time(frame);
  }
  return "nor later";
}

MissingReasons::Weighed MissingReasons::Weigh(Reason reason) {
  Weighed told{.reasons = {std::move(reason)}};
  const Reason* failure = FirstFailure(told.reasons);
  if (failure == nullptr) return told;
  told.missed = std::numeric_limits<double>::infinity();
  if (const std::optional<Reading>& reading = failure->reading)
    told.missed = Missed(reading->value, reading->limit);
  return told;
}

MissingReasons::Weighed MissingReasons::Weigh(
    grammar::NodeId node, const Viewpoint& at, bool truth,
    const std::function<Weighed(const Clauses::Clause&)>& tell) {
  const grammar::Node& n = past_.program().nodes[node];
  if (n.op == grammar::Op::kNot) return Weigh(n.args[0], at, !truth, tell);
  if (n.op != grammar::Op::kAnd && n.op != grammar::Op::kOr) return tell({node, truth});
  const bool is_choice = clauses_.IsChoice(node, truth);
  const bool is_fulfilled = past_.Is(truth, node, at);
  Weighed all{.missed = is_choice ? std::numeric_limits<double>::infinity() : 0};
  for (const grammar::NodeId arg : {n.args[0], n.args[1]}) {
    if (is_choice && is_fulfilled && !past_.Is(truth, arg, at)) continue;
    Weighed part = Weigh(arg, at, truth, tell);
    if (part.reasons.empty()) continue;
    const bool stands_first = is_choice ? part.missed < all.missed : part.missed > all.missed;
    if (stands_first) all.missed = part.missed;
    all.reasons.insert(stands_first ? all.reasons.begin() : all.reasons.end(),
                       std::make_move_iterator(part.reasons.begin()),
                       std::make_move_iterator(part.reasons.end()));
  }
  return all;
}

// What is required, as it was at the end.
Reasons MissingReasons::Requirement(const CandidateOutcome& outcome, int depth) {
  const FrameNumber last = std::min(outcome.span.end.frame, past_.frames() - 1);
  const Viewpoint at{
      .instance = outcome.instance, .frame = last, .begin = outcome.span.begin.frame, .end = last};
  const Window run{outcome.span.begin.frame, last};
  const auto tell = [&](const Clauses::Clause& clause) {
    Reason reason = clauses_.Told(clause, at);
    const grammar::Node& n = past_.program().nodes[clause.node];
    const InstanceId target = n.op == grammar::Op::kHolds && clause.truth
                                  ? past_.Referred(outcome.instance, n.slot)
                                  : kNone;
    if (reason.mark == Mark::kFailed && target != kNone)
      reason.because = OfInstance(target, run, depth + 1).reasons;
    reason.what = "requires " + reason.what;
    return Weigh(std::move(reason));
  };
  return Weigh(past_.RuleOf(outcome.instance).requirement, at, true, tell).reasons;
}

// Where the conditions that should have begun at the end came closest within the run.
Reasons MissingReasons::EndThatNeverCame(const CandidateOutcome& outcome, FrameNumber look_until,
                                         int depth) {
  const FromToRule& rule = past_.RuleOf(outcome.instance).As<FromToRule>();
  if (rule.absence) return {};
  const FrameNumber last = std::min({outcome.span.end.frame, past_.frames() - 1, look_until});
  const Viewpoint end{
      .instance = outcome.instance, .frame = last, .begin = outcome.span.begin.frame};
  const auto tell = [&](const Clauses::Clause& clause) {
    const grammar::Node& moment = past_.program().nodes[clause.node];
    const bool begins = moment.op == grammar::Op::kBegins;
    if ((!begins && moment.op != grammar::Op::kEnds) || !clause.truth) return Weighed{};
    const grammar::Node& of = past_.program().nodes[moment.args[0]];
    if (of.op == grammar::Op::kHolds)
      return Weigh(MomentOf(past_.Referred(outcome.instance, of.slot), begins,
                            {outcome.span.begin.frame, last}, depth));
    if (!begins) return Weighed{};
    Viewpoint at = end;
    at.frame = Closest(moment.args[0], at, {outcome.span.begin.frame, last});
    return Weigh(moment.args[0], at, true, [&](const Clauses::Clause& part) {
      Reason reason = clauses_.Told(part, at);
      if (!reason.reading) return Weighed{};
      reason.what = "to " + reason.what;
      return Weigh(std::move(reason));
    });
  };
  return Weigh(rule.to, end, true, tell).reasons;
}

// Of a rule whose begin or end was waited for: when it came instead, or why it never held.
Reason MissingReasons::MomentOf(InstanceId target, bool begins, const Window& run, int depth) {
  Reason reason{.mark = Mark::kFailed, .what = begins ? "to it begins" : "to it ends"};
  if (target == kNone) return reason;
  reason.what = "to " + Label(past_, target) + (begins ? " begins" : " ends");
  const CandidateOutcome* held = past_.LastBegun(target, run.last);
  const bool is_there = held != nullptr && held->span.end.frame > run.first;
  if (is_there) {
    reason.how = "it held " + truth::IntervalText({held->span.begin.tick, held->span.end.tick},
                                                  past_.entity_table().ticks_per_second);
    return reason;
  }
  reason.how =
      "it did not hold from " + clauses_.Time(run.first) + " to " + clauses_.Time(run.last);
  if (past_.RuleOf(target).form() != grammar::Form::kTouching)
    reason.because = OfInstance(target, run, depth + 1).reasons;
  return reason;
}

void MissingReasons::AddClauses(const char* word, grammar::NodeId node, const Viewpoint& at,
                                Reasons& reasons) {
  for (Reason& reason : clauses_.State(node, at, true)) {
    reason.what = word + reason.what;
    reasons.push_back(std::move(reason));
  }
}

std::string MissingReasons::Lasted(const CandidateOutcome& outcome) {
  return Duration(outcome.span.end.tick - outcome.span.begin.tick,
                  past_.entity_table().ticks_per_second);
}

MissingReasons::Telling MissingReasons::Unconfirmed(const CandidateOutcome& outcome,
                                                    FrameNumber over, int depth) {
  const Rule& rule = past_.RuleOf(outcome.instance);
  const InstanceId by = past_.Referred(outcome.instance, rule.confirmed_by);
  const InstanceId within = past_.Referred(outcome.instance, rule.confirmed_within);
  const bool episode = over >= past_.frames();
  Telling told{"not confirmed", OnlyFailed("confirmed by " + Label(past_, by),
                                           "it did not begin before " +
                                               (episode ? std::string("the episode ended")
                                                        : Label(past_, within) + " was over") +
                                               " at " + clauses_.Time(over))};
  const Window wait{outcome.span.end.frame, std::min(over, past_.frames() - 1)};
  told.because.back().because = OfInstance(by, wait, depth + 1).reasons;
  return told;
}

MissingReasons::Telling MissingReasons::NothingBefore(const CandidateOutcome& outcome) {
  Telling told{"nothing before its end at " + clauses_.Time(outcome.span.end.frame),
               events_.CutOfWalk(outcome.instance, outcome)};
  for (Reason& cut : told.because) cut.mark = Mark::kFailed;
  const FrameNumber last = std::min(outcome.span.end.frame, past_.frames() - 1);
  AddClauses(
      "since ", past_.RuleOf(outcome.instance).As<UntilSinceRule>().since,
      {.instance = outcome.instance, .frame = std::max<FrameNumber>(last - 1, 0), .end = last},
      told.because);
  return told;
}

// One per fate of a run: a new one does not compile without its words.
MissingReasons::Telling MissingReasons::Tell(const CandidateOutcome& outcome, int depth,
                                             FrameNumber look_until) {
  struct Teller {
    MissingReasons& reasons;
    const CandidateOutcome& outcome;
    int depth;
    FrameNumber look_until;
    const Rule& rule = reasons.past_.RuleOf(outcome.instance);

    Telling operator()(fate::TooShort) const {
      return {"too short", OnlyFailed("lasting " + QuantityText(rule.lasting_s, grammar::kSeconds),
                                      "it lasted only " + reasons.Lasted(outcome))};
    }
    Telling operator()(fate::TooLong) const {
      return {"too long",
              OnlyFailed("lasting .. to " + QuantityText(rule.lasting_most_s, grammar::kSeconds),
                         "it lasted " + reasons.Lasted(outcome))};
    }
    Telling operator()(fate::TooFew few) const {
      return {"too few",
              OnlyFailed("at least " + std::to_string(rule.As<grammar::WhileRule>().at_least),
                         "there " + std::string(few.found == 1 ? "was " : "were ") +
                             std::to_string(few.found))};
    }
    Telling operator()(fate::Refused) const {
      return {"not what is required", reasons.Requirement(outcome, depth)};
    }
    Telling operator()(fate::Unconfirmed unconfirmed) const {
      return reasons.Unconfirmed(outcome, unconfirmed.over, depth);
    }
    Telling operator()(fate::Dropped dropped) const {
      Telling told{"dropped", reasons.EndThatNeverCame(outcome, look_until, depth)};
      reasons.AddClauses(
          "during ", rule.As<FromToRule>().during,
          {.instance = outcome.instance, .frame = dropped.at, .begin = outcome.span.begin.frame},
          told.because);
      return told;
    }
    Telling operator()(fate::TooLate) const {
      return {"dropped",
              OnlyFailed(reasons.Awaited(outcome.instance),
                         "it did not come within " + Within() + ", " + reasons.HowLate(outcome))};
    }
    Telling operator()(fate::Came) const {
      return {
          "what must not come came",
          OnlyFailed(reasons.Awaited(outcome.instance),
                     "it came after " + reasons.Lasted(outcome) + ", at " +
                         At(outcome.span.end.tick, reasons.past_.entity_table().ticks_per_second))};
    }
    Telling operator()(fate::Unfinished) const {
      return {"dropped",
              OnlyFailed(reasons.Awaited(outcome.instance),
                         !rule.As<FromToRule>().absence ? "the episode ended before"
                                                        : "it is decided only " + Within() +
                                                              " later, the episode ended before")};
    }
    Telling operator()(fate::NothingBack) const { return reasons.NothingBefore(outcome); }
    Telling operator()(fate::Interval) const { return {}; }
    Telling operator()(fate::WalkedBack) const { return {}; }
    std::string Within() const {
      return QuantityText(rule.As<FromToRule>().within_s, grammar::kSeconds);
    }
  };
  return std::visit(Teller{*this, outcome, depth, look_until}, outcome.fate);
}

MissingReasons::Cause MissingReasons::OfRun(const CandidateOutcome& outcome, int depth,
                                            FrameNumber look_until) {
  const Rule& rule = past_.RuleOf(outcome.instance);
  Telling told = Tell(outcome, depth, look_until);
  const std::string span = "from " + clauses_.Time(outcome.span.begin.frame) + " to " +
                           At(outcome.span.end.tick, past_.entity_table().ticks_per_second) + ": ";
  Reason run{.mark = Mark::kFailed,
             .what = Label(past_, outcome.instance),
             .how = (outcome.If<fate::NothingBack>() != nullptr ? "" : span) + told.how,
             .where = Source(rule.file, rule.place),
             .tick = outcome.span.begin.tick,
             .because = std::move(told.because)};
  const bool has_end =
      outcome.If<fate::TooShort>() != nullptr || outcome.If<fate::TooLong>() != nullptr ||
      outcome.If<fate::TooFew>() != nullptr || outcome.If<fate::Refused>() != nullptr;
  if (has_end) {
    Reason began{.mark = Mark::kNote,
                 .what = "it began there",
                 .because = events_.CutOfWalk(outcome.instance, outcome)};
    if (!began.because.empty()) run.because.push_back(std::move(began));
    Reason ended{.mark = Mark::kNote,
                 .what = "it ended there",
                 .because = events_.End(outcome.instance, outcome, kMaxDepth - 1)};
    run.because.push_back(std::move(ended));
  }
  return {{std::move(run)}, RunCloseness(outcome)};
}

}  // namespace prehend::show

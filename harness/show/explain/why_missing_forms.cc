// SPDX-License-Identifier: Apache-2.0
// Where there was no run: which clause kept each form from beginning one.
// Tested by tests/harness/show/explain/why_missing_test.cc

#include <algorithm>
#include <cmath>

#include "grammar/base/allen.h"
#include "harness/show/explain/query.h"
#include "harness/show/explain/why_missing.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {

using grammar::CandidateOutcome;
using grammar::Form;
using grammar::FrameNumber;
using grammar::InstanceId;
using grammar::kNone;
using grammar::Op;
using grammar::Rule;
using grammar::UntilSinceRule;
using Mark = Reason::Mark;

namespace {

/// Of a longer window only this many frames are sampled.
constexpr FrameNumber kMaxSampledFrames = 2000;
constexpr std::size_t kMaxIntervals = 4;  // are listed

Reason Failed(std::string what, std::string how, Reasons because = {}) {
  return {.mark = Mark::kFailed,
          .what = std::move(what),
          .how = std::move(how),
          .because = std::move(because)};
}

// "meets|before within 0.3 s"
std::string Text(const grammar::ComposeRule::Clause& clause) {
  std::string text;
  for (std::size_t i = 0; i < grammar::kAllenNames.size(); ++i) {
    if ((clause.relations >> i & 1U) == 0) continue;
    text += (text.empty() ? "" : "|") + std::string(grammar::kAllenNames[i]);
    if (clause.within_s[i] >= 0)
      text += " within " + QuantityText(clause.within_s[i], grammar::kSeconds);
  }
  return text;
}

}  // namespace

// "contact(hand, cup)  1.0..2.0 s, 3.0..4.0 s"
Reason MissingReasons::Intervals(InstanceId instance, std::string how) {
  std::size_t count = 0;
  for (const CandidateOutcome& outcome : past_.OutcomesOf(instance)) {
    if (!outcome.IsInterval()) continue;
    if (count++ == kMaxIntervals) how += ", ..";
    if (count > kMaxIntervals) continue;
    how += (count == 1 ? " " : ", ") +
           truth::IntervalText({outcome.span.begin.tick, outcome.span.end.tick},
                               past_.entity_table().ticks_per_second);
  }
  return {.mark = Mark::kNote, .what = Label(past_, instance), .how = count == 0 ? "never" : how};
}

MissingReasons::Cause MissingReasons::OfForm(InstanceId instance, const Window& window, int depth) {
  switch (past_.RuleOf(instance).form()) {
    case Form::kTouching:
      return OfFact(instance, window);
    case Form::kAny:
      return OfAny(instance, window, depth);
    case Form::kWhile:
      return OfWhile(instance, window, depth);
    case Form::kFromTo:
      return OfFromTo(instance, window, depth);
    case Form::kUntilSince:
      return OfUntil(instance, window, depth);
    case Form::kRestOf:
      return OfRest(instance, window, depth);
    case Form::kCompose:
      return OfCompose(instance, window, depth);
  }
  return {};
}

MissingReasons::Cause MissingReasons::OfFact(InstanceId instance, const Window& window) {
  const bool at = window.at.has_value();
  Reason reason =
      Failed(Label(past_, instance),
             at ? "they did not touch at " + clauses_.Time(*window.at) : "they did not touch");
  if (!past_.OutcomesOf(instance).empty())
    reason.because.push_back(Intervals(instance, "they touched"));
  return {{std::move(reason)}, 0};
}

FrameNumber MissingReasons::Closest(grammar::NodeId node, Viewpoint at, const Window& window) {
  FrameNumber first = window.first;
  FrameNumber last = window.last;
  if (window.at) {
    // Of the interval around the moment in which it does not hold.
    const auto fails = [&](FrameNumber frame) {
      at.frame = frame;
      return !past_.Truth(node, at);
    };
    if (!fails(*window.at)) return *window.at;
    FrameNumber from = *window.at;
    FrameNumber to = *window.at;
    while (from > first && fails(from - 1)) --from;
    while (to < last && fails(to + 1)) ++to;
    first = from;
    last = to;
  }
  const FrameNumber step = std::max<FrameNumber>(1, (last - first) / kMaxSampledFrames);
  FrameNumber closest = window.at.value_or(first);
  at.frame = closest;
  double best = clauses_.Nearness(node, at, true);
  for (FrameNumber frame = first; frame <= last; frame += step) {
    at.frame = frame;
    const double nearness = clauses_.Nearness(node, at, true);
    if (nearness <= best) continue;
    best = nearness;
    closest = frame;
  }
  return closest;
}

MissingReasons::Cause MissingReasons::OfClauses(grammar::NodeId node, Viewpoint at,
                                                const Window& window, int depth) {
  at.frame = Closest(node, at, window);
  Cause cause{.closeness = clauses_.Nearness(node, at, true)};
  bool followed = false;
  for (const Clauses::Clause& clause : clauses_.Split(node, at, true)) {
    Reason reason = clauses_.Told(clause, at);
    const grammar::Node& n = past_.program().nodes[clause.node];
    if (reason.mark == Mark::kFailed && n.op == Op::kHolds && !clause.truth) {
      reason.because = WhyItHolds(past_.Referred(at.instance, n.slot), at.frame);
      for (const Reason& by : reason.because)
        reason.how += (&by == &reason.because.front() ? ", by " : " and ") + by.what;
    }
    const bool follow = reason.mark == Mark::kFailed && !followed;
    followed |= reason.mark == Mark::kFailed;
    if (follow && n.op == Op::kHolds && clause.truth) {
      Follow(reason, past_.Referred(at.instance, n.slot), at.frame, window, depth);
    }
    cause.reasons.push_back(std::move(reason));
  }
  return cause;
}

Reasons MissingReasons::WhyItHolds(InstanceId instance, FrameNumber frame) {
  Reasons reasons;
  const auto add = [&](InstanceId target) {
    const CandidateOutcome* holds = target == kNone ? nullptr : past_.Covering(target, frame);
    if (holds == nullptr) return;
    const Rule& rule = past_.RuleOf(target);
    reasons.push_back(
        {.mark = Mark::kHeld,
         .what = Label(past_, target),
         .how = "held " + truth::IntervalText({holds->span.begin.tick, holds->span.end.tick},
                                              past_.entity_table().ticks_per_second),
         .where = rule.form() == Form::kTouching ? "" : Source(rule.file, rule.place)});
  };
  const auto add_all = [&](InstanceId target) {
    if (target == kNone || past_.RuleOf(target).form() != Form::kAny) return add(target);
    std::vector<InstanceId> members = past_.MembersOf(target);
    std::ranges::sort(members, {}, [&](InstanceId member) { return past_.EntitiesOf(member); });
    for (const InstanceId member : members) add(member);
  };
  if (instance == kNone) return reasons;
  if (past_.RuleOf(instance).form() == Form::kAny) add_all(instance);
  if (const auto* rule = past_.RuleOf(instance).If<grammar::WhileRule>()) {
    const Viewpoint at{.instance = instance, .frame = frame};
    for (const Clauses::Clause& clause : clauses_.Split(rule->condition, at, true)) {
      const grammar::Node& n = past_.program().nodes[clause.node];
      if (n.op == Op::kHolds && clause.truth) add_all(past_.Referred(instance, n.slot));
    }
  }
  return reasons;
}

// Into the rule that decides. What never held is looked for everywhere, if no moment was asked for.
void MissingReasons::Follow(Reason& reason, InstanceId target, FrameNumber frame,
                            const Window& window, int depth) {
  if (target == kNone || past_.RuleOf(target).form() == Form::kTouching) return;
  const bool never = past_.LastBegun(target, past_.frames()) == nullptr;
  Reasons behind =
      OfInstance(target, never && !window.at ? window : Within(window, frame), depth + 1).reasons;
  if (behind.size() == 1 && behind.front().what == reason.what) {
    // "begins at 2 s" and "begins at 2 s only"
    reason.how = behind.front().how.starts_with(reason.how)
                     ? behind.front().how
                     : reason.how + "; " + behind.front().how;
    reason.where = behind.front().where;
    behind = Reasons(std::move(behind.front().because));
  }
  reason.because = std::move(behind);
}

MissingReasons::Cause MissingReasons::OfWhile(InstanceId instance, const Window& window,
                                              int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const grammar::NodeId condition = rule.As<grammar::WhileRule>().condition;
  Cause inner = OfClauses(condition, {.instance = instance}, window, depth);
  const FrameNumber closest = Closest(condition, {.instance = instance}, window);
  Reason reason = Failed(Label(past_, instance), "came closest at " + clauses_.Time(closest),
                         std::move(inner.reasons));
  reason.where = Source(rule.file, rule.place);
  reason.tick = past_.TickOf(closest);
  return {{std::move(reason)}, inner.closeness};
}

MissingReasons::Cause MissingReasons::OfMoment(grammar::NodeId node, InstanceId instance,
                                               const Window& window, int depth) {
  // Some of it happened, but not all at once.
  const Viewpoint at{.instance = instance, .frame = Closest(node, {.instance = instance}, window)};
  if (past_.program().nodes[node].op == Op::kAnd && clauses_.Nearness(node, at, true) >= 0.5) {
    return OfClauses(node, {.instance = instance}, window, depth);
  }
  Cause best;
  for (const Clauses::Clause& clause : clauses_.Split(node, at, true)) {
    const grammar::Node& n = past_.program().nodes[clause.node];
    if (!clause.truth || (n.op != Op::kBegins && n.op != Op::kEnds)) continue;
    const grammar::Node& arg = past_.program().nodes[n.args[0]];
    Cause cause;
    if (arg.op == Op::kHolds) {
      const InstanceId target = past_.Referred(instance, arg.slot);
      if (target == kNone) continue;
      const bool ever = past_.LastBegun(target, past_.frames()) != nullptr;
      const CandidateOutcome* last = past_.LastBegun(target, window.last);
      const bool here = last != nullptr && last->span.end.frame >= window.first;
      if (!here) cause = OfInstance(target, window, depth + 1);
      if (ever) {
        cause.reasons.insert(cause.reasons.begin(), Intervals(target, "is there at"));
        cause.closeness = 0.95;
      }
    } else {
      cause = OfClauses(n.args[0], {.instance = instance}, window, depth);
    }
    if (best.reasons.empty() || cause.closeness > best.closeness) best = std::move(cause);
  }
  return best;
}

MissingReasons::Cause MissingReasons::OfFromTo(InstanceId instance, const Window& window,
                                               int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const auto& [opens, closes, during, or_drop, absence, each, within_s] =
      rule.As<grammar::FromToRule>();
  // The last moment that should have begun it.
  const FrameNumber until = window.at.value_or(window.last);
  FrameNumber from = until;
  const auto begins = [&, opens = opens](FrameNumber frame) {
    return past_.Truth(opens, {.instance = instance, .frame = frame, .begin = frame});
  };
  while (from >= 0 && !begins(from)) --from;
  Reason reason = Failed(Label(past_, instance), "", {});
  reason.where = Source(rule.file, rule.place);
  if (from < 0) {
    Cause cause = OfMoment(opens, instance, window, depth);
    reason.how = "nothing began it";
    reason.because = {Failed("from " + ClauseText(past_, instance, opens),
                             "did not become true by " + clauses_.Time(until),
                             std::move(cause.reasons))};
    return {{std::move(reason)}, 0.5 * cause.closeness};
  }
  for (const CandidateOutcome& outcome : past_.OutcomesOf(instance)) {
    if (outcome.span.begin.frame != from) continue;
    if (!outcome.IsInterval()) return OfRun(outcome, depth);
    reason.how = "the one before, " +
                 truth::IntervalText({outcome.span.begin.tick, outcome.span.end.tick},
                                     past_.entity_table().ticks_per_second) +
                 ", was over already";
    reason.because = events_.End(instance, outcome);
    return {{std::move(reason)}, 0.9};
  }
  reason.how = "could have begun at " + clauses_.Time(from);
  const Viewpoint at{.instance = instance, .frame = from, .begin = from};
  if (during != kNone && !past_.Truth(during, at)) {
    for (Reason& state : clauses_.State(during, at, true)) {
      state.what = "during " + state.what;
      reason.because.push_back(std::move(state));
    }
  } else {
    reason.because = {Failed(Awaited(instance), "was at the same moment, and that is no interval")};
  }
  return {{std::move(reason)}, 0.8};
}

Reason MissingReasons::ClosestApproach(InstanceId instance, const Window& window) {
  const grammar::NodeId signal = past_.RuleOf(instance).As<UntilSinceRule>().approach->signal;
  Reason reason{.mark = Mark::kNote, .what = ClauseText(past_, instance, signal)};
  double smallest = 0;
  for (FrameNumber frame = window.first; frame <= window.last; ++frame) {
    const double value =
        past_.Number(signal, {.instance = instance, .frame = frame, .end = window.last})
            .value_or(0);
    if (std::isnan(value) || (reason.tick && value >= smallest)) continue;
    smallest = value;
    reason.tick = past_.TickOf(frame);
  }
  if (!reason.tick) {
    reason.how = "is unknown: what it measures is not tracked";
    return reason;
  }
  reason.how = "was smallest at " + At(*reason.tick, past_.entity_table().ticks_per_second) + ": " +
               QuantityText(smallest, NoteOf(past_.program(), signal).dimension);
  return reason;
}

// Whatever ended later begins too late; whatever came to nothing later, did so; unless it looks
// back less far than that.
std::optional<MissingReasons::Cause> MissingReasons::OfLaterEnd(InstanceId instance, FrameNumber at,
                                                                int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const double back_s = rule.As<UntilSinceRule>().back_s;
  for (const CandidateOutcome& outcome : RunsOf(instance)) {
    if (outcome.span.end.frame <= at) continue;
    const bool reaches = outcome.span.end.tick - past_.TickOf(at) <= past_.AtMostTicks(back_s);
    const bool is_interval = outcome.IsInterval();
    if (reaches && !is_interval) return OfRun(outcome, depth);
    Reason reason = Failed(Label(past_, instance), "");
    reason.where = Source(rule.file, rule.place);
    if (is_interval) {
      reason.how = "begins at " + clauses_.Time(outcome.span.begin.frame) + " only";
      reason.because = events_.Begin(instance, outcome);
    } else {
      const std::string back = QuantityText(back_s, grammar::kSeconds);
      reason.how = "the next end is at " + clauses_.Time(outcome.span.end.frame) +
                   ", and the rule reaches at most " + back + " back";
    }
    return Cause{{std::move(reason)}, 0.9};
  }
  return std::nullopt;
}

MissingReasons::Cause MissingReasons::OfUntil(InstanceId instance, const Window& window,
                                              int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const UntilSinceRule& part = rule.As<UntilSinceRule>();
  if (window.at) {
    if (std::optional<Cause> later = OfLaterEnd(instance, *window.at, depth))
      return *std::move(later);
  }
  const Window rest = window.at ? Window{*window.at, past_.frames() - 1} : window;
  Cause cause = OfMoment(part.until, instance, rest, depth);
  const bool whole = rest.first == 0 && rest.last >= past_.frames() - 1;
  const std::string when = whole ? "never became true"
                           : window.at
                               ? "did not become true at or after " + clauses_.Time(rest.first)
                               : "did not become true from " + clauses_.Time(rest.first) + " to " +
                                     clauses_.Time(rest.last);
  Reason reason = Failed(Label(past_, instance), "nothing ended it");
  reason.where = Source(rule.file, rule.place);
  reason.because = {
      Failed("until " + ClauseText(past_, instance, part.until), when, std::move(cause.reasons))};
  if (part.approach) reason.because.push_back(ClosestApproach(instance, window));
  return {{std::move(reason)}, 0.5 * cause.closeness};
}

MissingReasons::Cause MissingReasons::OfRest(InstanceId instance, const Window& window, int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const auto& rest = rule.As<grammar::RestOfRule>();
  const InstanceId whole = past_.Referred(instance, rest.whole);
  Reason reason = Failed(Label(past_, instance), "", {});
  reason.where = Source(rule.file, rule.place);
  const auto covers = [&](InstanceId target, FrameNumber frame) {
    return target != kNone && past_.Covering(target, frame) != nullptr;
  };
  FrameNumber frame = window.at.value_or(window.first);
  for (; !window.at && frame < window.last && !covers(whole, frame); ++frame) {
  }
  if (!covers(whole, frame)) {
    reason.how = "is a rest of " + (whole == kNone ? "nothing" : Label(past_, whole));
    Reason missing = Failed(whole == kNone ? "it" : Label(past_, whole),
                            window.at ? "did not hold at " + clauses_.Time(frame) : "never held",
                            OfInstance(whole, window, depth + 1).reasons);
    reason.because = {std::move(missing)};
    return {{std::move(reason)}, 0.1};
  }
  reason.how = "nothing is left of " + Label(past_, whole) + " at " + clauses_.Time(frame);
  for (const int slot : rest.outside) {
    const InstanceId target = past_.Referred(instance, slot);
    if (!covers(target, frame)) continue;
    const CandidateOutcome& outcome = *past_.Covering(target, frame);
    Reason covered =
        Failed("outside " + Label(past_, target),
               "it held " + truth::IntervalText({outcome.span.begin.tick, outcome.span.end.tick},
                                                past_.entity_table().ticks_per_second));
    if (const auto* looks_back = past_.RuleOf(target).If<UntilSinceRule>()) {
      const Viewpoint at{.instance = target,
                         .frame = frame,
                         .begin = outcome.span.begin.frame,
                         .end = outcome.span.end.frame};
      covered.because = clauses_.State(looks_back->since, at, true);
    }
    reason.because.push_back(std::move(covered));
  }
  return {{std::move(reason)}, 0.7};
}

MissingReasons::Cause MissingReasons::OfAny(InstanceId instance, const Window& window, int depth) {
  Cause best{{Failed(Label(past_, instance), "nothing that fits was there")}, -1};
  const grammar::Reference& reference = past_.RuleOf(instance).references[0];
  grammar::Binding wanted = grammar::kUnbound;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (reference.roles[i] != kNone) wanted[i] = past_.EntitiesOf(instance)[reference.roles[i]];
  }
  for (const InstanceId candidate : BindingsThatFit(past_, reference.rule, wanted)) {
    Cause cause = OfInstance(candidate, window, depth + 1);
    if (cause.closeness > best.closeness) best = std::move(cause);
  }
  if (past_.RuleOf(instance).As<grammar::AnyRule>().at_least == 1) return best;
  Reason fewer = Failed(Label(past_, instance), "fewer were there at once");
  for (const InstanceId member : past_.MembersOf(instance))
    fewer.because.push_back(Intervals(member, "was there"));
  return {{std::move(fewer)}, 0};
}

// That can stand for a part of a composition.
std::vector<grammar::Interval> MissingReasons::IntervalsFor(InstanceId composition, int part) {
  std::vector<grammar::Interval> intervals;
  const auto& rule = past_.RuleOf(composition).As<grammar::ComposeRule>();
  for (const int slot : rule.ChoicesFor(part)) {
    for (const CandidateOutcome& one : past_.OutcomesOf(past_.Referred(composition, slot)))
      if (one.IsInterval()) intervals.push_back({one.span.begin.tick, one.span.end.tick});
  }
  return intervals;
}

MissingReasons::Cause MissingReasons::OfCompose(InstanceId instance, const Window& window,
                                                int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const auto& composition = rule.As<grammar::ComposeRule>();
  const bool repeats = composition.at_least > 0;
  const std::string within =
      composition.within_s > 0 ? " within " + QuantityText(composition.within_s, grammar::kSeconds)
                               : "";
  Reason reason = Failed(Label(past_, instance),
                         (repeats ? "needs " + std::to_string(composition.at_least) + " intervals"
                                  : "needs all its parts") +
                             within,
                         {});
  reason.where = Source(rule.file, rule.place);
  std::vector<InstanceId> parts;
  const auto is_never = [&](int slot) {
    return past_.LastBegun(past_.Referred(instance, slot), past_.frames()) == nullptr;
  };
  bool complete = true;
  for (const int slot : composition.parts) {
    const int list = composition.lists[parts.size()];
    parts.push_back(past_.Referred(instance, slot));
    if (parts.back() == kNone) return {{std::move(reason)}, 0};
    const bool is_absent = list >= composition.count;
    Reason part = Intervals(parts.back(), is_absent ? "must not lie between" : "was there");
    if (!is_absent && std::ranges::all_of(composition.ChoicesFor(list), is_never)) {
      part.mark = Mark::kFailed;
      if (complete) part.because = OfInstance(parts.back(), window, depth + 1).reasons;
      complete = false;
    }
    reason.because.push_back(std::move(part));
  }
  for (const grammar::ComposeRule::Clause& clause : composition.clauses) {
    if (!complete) break;
    const grammar::Relations wanted =
        clause.In([this](double seconds) { return past_.AtMostTicks(seconds); });
    bool holds = false;
    std::string relation;
    for (const grammar::Interval& left : IntervalsFor(instance, clause.left)) {
      for (const grammar::Interval& right : IntervalsFor(instance, clause.right)) {
        holds |= wanted.Fit(left, right);
        const grammar::Allen is = grammar::Relate(left, right);
        const grammar::Tick gap = std::max(right.begin - left.end, left.begin - right.end);
        relation = grammar::kAllenNames[static_cast<std::size_t>(is)];
        if (gap > 0)
          relation += ", " + QuantityText(clauses_.Seconds(gap), grammar::kSeconds) + " apart";
      }
    }
    if (holds) continue;
    reason.because.push_back(Failed(Label(past_, parts[clause.left]) + " " + Text(clause) + " " +
                                        Label(past_, parts[clause.right]),
                                    "it is " + relation));
  }
  return {{std::move(reason)}, complete ? 0.9 : 0.4};
}

}  // namespace prehend::show

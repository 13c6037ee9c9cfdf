// SPDX-License-Identifier: Apache-2.0
#include "harness/show/explain/why_event.h"

#include <fmt/format.h>

#include <algorithm>

#include "grammar/base/allen.h"
#include "harness/show/explain/query.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::show {

using grammar::CandidateOutcome;
using grammar::Form;
using grammar::FrameNumber;
using grammar::FromToRule;
using grammar::InstanceId;
using grammar::kNone;
using grammar::RestOfRule;
using grammar::Rule;
using grammar::Tick;
using grammar::UntilSinceRule;
using grammar::WalkBack;
using grammar::WhileRule;
using Mark = Reason::Mark;

namespace {

Reason Remark(std::string what, std::string how = {}) {
  return {.mark = Mark::kNote, .what = std::move(what), .how = std::move(how)};
}

// The frame, if it needed one.
std::optional<FrameNumber> ConfirmedAt(const CandidateOutcome& outcome) {
  const auto* interval = outcome.If<grammar::fate::Interval>();
  const bool is_confirmed = interval != nullptr && interval->confirmed != grammar::kNever;
  return is_confirmed ? std::optional(interval->confirmed) : std::nullopt;
}

// A clause that stands in both is told once.
void AddNew(Reasons more, Reasons& reasons) {
  for (Reason& reason : more) {
    const auto same = [&](const Reason& other) { return other.what == reason.what; };
    if (std::none_of(reasons.begin(), reasons.end(), same)) reasons.push_back(std::move(reason));
  }
}

}  // namespace

std::string EventReasons::Seconds(double seconds) const {
  return QuantityText(seconds, grammar::kSeconds);
}

Clauses::Follow EventReasons::FollowFrom(int depth) {
  return [this, depth](InstanceId instance, const CandidateOutcome& outcome, bool end) {
    if (depth >= kMaxDepth) return Reasons{};
    return end ? End(instance, outcome, depth + 1) : Begin(instance, outcome, depth + 1);
  };
}

Reasons EventReasons::Change(grammar::NodeId node, const Viewpoint& at, bool truth, int depth) {
  return node == kNone ? Reasons{} : clauses_.Change(node, at, truth, FollowFrom(depth), brief_);
}

Reasons EventReasons::Begin(InstanceId instance, const CandidateOutcome& outcome, int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const FrameNumber begin = outcome.span.begin.frame;
  switch (rule.form()) {
    case Form::kTouching:
      return {};
    case Form::kAny:
      return BeginOrEndOfAny(instance, begin, false, depth);
    case Form::kWhile: {
      const Viewpoint at{.instance = instance, .frame = begin, .begin = begin};
      Reasons reasons = Change(rule.As<WhileRule>().condition, at, true, depth);
      AddNew(Change(rule.As<WhileRule>().until, at, false, depth), reasons);
      return reasons;
    }
    case Form::kFromTo: {
      const Viewpoint at{.instance = instance, .frame = begin, .begin = begin};
      Reasons reasons = Change(rule.As<FromToRule>().from, at, true, depth);
      AddNew(Change(rule.As<FromToRule>().during, at, true, kMaxDepth), reasons);
      return reasons;
    }
    case Form::kUntilSince:
      return BeginOfWalk(instance, outcome, depth);
    case Form::kRestOf:
      return BeginOrEndOfRest(instance, begin, true, depth);
    case Form::kCompose:
      return Parts(instance, outcome, depth);
  }
  return {};
}

Reasons EventReasons::End(InstanceId instance, const CandidateOutcome& outcome, int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const FrameNumber begin = outcome.span.begin.frame;
  const FrameNumber end = outcome.span.end.frame;
  // That B did not come is decided by time alone; what comes in that frame comes too late.
  const auto* from_to = rule.If<FromToRule>();
  if (from_to != nullptr && from_to->absence)
    return {Remark("nothing came within " + Seconds(from_to->within_s))};
  if (end >= past_.frames()) return {Remark("the episode ends here")};
  switch (rule.form()) {
    case Form::kTouching:
      return {};
    case Form::kAny:
      return BeginOrEndOfAny(instance, end, true, depth);
    case Form::kWhile: {
      const WhileRule& part = rule.As<WhileRule>();
      const bool hysteresis = part.until != kNone;
      return Change(hysteresis ? part.until : part.condition,
                    {.instance = instance, .frame = end, .begin = begin}, hysteresis, depth);
    }
    case Form::kFromTo: {
      const Viewpoint at{.instance = instance, .frame = end, .begin = begin};
      const bool closed = past_.Truth(from_to->to, at);
      return Change(closed ? from_to->to : from_to->during, at, closed, depth);
    }
    case Form::kUntilSince:
      return Change(rule.As<UntilSinceRule>().until, {.instance = instance, .frame = end}, true,
                    depth);
    case Form::kRestOf:
      return BeginOrEndOfRest(instance, end, false, depth);
    case Form::kCompose: {
      std::vector<const CandidateOutcome*> parts;
      if (!ChooseParts(instance, outcome, parts)) return {};
      const auto ends = [&](const CandidateOutcome* part) { return part->span.end.frame == end; };
      const CandidateOutcome& final =
          ends(parts.back()) ? *parts.back() : **std::ranges::find_if(parts, ends);
      Reason last = Remark(Label(past_, final.instance), "ended");
      last.mark = Mark::kTurned;
      if (depth < kMaxDepth) last.because = End(final.instance, final, depth + 1);
      return {std::move(last)};
    }
  }
  return {};
}

Reasons EventReasons::CutOfWalk(InstanceId instance, const CandidateOutcome& outcome) {
  const auto* rule = past_.RuleOf(instance).If<UntilSinceRule>();
  if (rule == nullptr || !rule->approach) return {};
  Reasons reasons;
  if (outcome.walk.stop == WalkBack::Stop::kReceding)
    reasons = {
        Remark("the approach turns here: " + ClauseText(past_, instance, rule->approach->signal),
               TurnText(instance, outcome))};
  if (outcome.walk.stop == WalkBack::Stop::kIdle)
    reasons = {Remark("it paused before that", PauseText(instance, outcome))};
  for (Reason& reason : reasons) reason.mark = Mark::kTurned;
  return reasons;
}

// "is 96 mm; at 1.9 s it was 71 mm, until 2.1 s it receded by 25 mm, and it may recede by .."
std::string EventReasons::TurnText(InstanceId instance, const CandidateOutcome& outcome) {
  const grammar::Approach& approach = *past_.RuleOf(instance).As<UntilSinceRule>().approach;
  const FrameNumber at = outcome.walk.at, end = outcome.span.end.frame;
  const auto signal = [&](FrameNumber frame) {
    return past_.Number(approach.signal, {.instance = instance, .frame = frame, .end = end})
        .value_or(0);
  };
  const auto text = [&](double value) {
    return QuantityText(value, NoteOf(past_.program(), approach.signal).dimension);
  };
  FrameNumber top = at;
  for (FrameNumber frame = at; frame <= std::min(end, past_.frames() - 1); ++frame) {
    if (signal(frame) > signal(top)) top = frame;
  }
  // Medians over a while recede less than single values do.
  const std::string receded = approach.over_s > 0
                                  ? ""
                                  : fmt::format(", until {} it receded by {}", clauses_.Time(top),
                                                text(signal(top) - signal(at)));
  return fmt::format("is {}; at {} it was {}{}, and it may recede by at most {}",
                     text(signal(outcome.span.begin.frame)), clauses_.Time(at), text(signal(at)),
                     receded, text(approach.slack));
}

std::string EventReasons::PauseText(InstanceId instance, const CandidateOutcome& outcome) {
  const grammar::Approach& approach = *past_.RuleOf(instance).As<UntilSinceRule>().approach;
  const FrameNumber after = outcome.walk.at, end = outcome.span.end.frame;
  // Whether a trembling hand stays in its place is not asked again.
  if (approach.hand != kNone) return "for more than " + Seconds(approach.idle_s);
  const auto number = [&](grammar::NodeId node, FrameNumber frame) {
    return past_.Number(node, {.instance = instance, .frame = frame, .end = end}).value_or(0);
  };
  const auto is_slow = [&](FrameNumber frame) {
    const double speed =
        approach.motion != kNone
            ? number(approach.motion, frame + 1)
            : (number(approach.signal, frame) - number(approach.signal, frame + 1)) /
                  clauses_.Seconds(past_.TickOf(frame + 1) - past_.TickOf(frame));
    return speed < approach.speed;
  };
  FrameNumber from = after;
  while (from > 0 && is_slow(from - 1)) --from;
  return fmt::format("from {} to {}, {}, and a pause may last {}", clauses_.Time(from),
                     clauses_.Time(after),
                     Seconds(clauses_.Seconds(past_.TickOf(after) - past_.TickOf(from))),
                     Seconds(approach.idle_s));
}

// What stopped the walk back from the end.
Reasons EventReasons::BeginOfWalk(InstanceId instance, const CandidateOutcome& outcome, int depth) {
  const UntilSinceRule& rule = past_.RuleOf(instance).As<UntilSinceRule>();
  const std::optional<grammar::Approach>& approach = rule.approach;
  const FrameNumber begin = outcome.span.begin.frame;
  const FrameNumber end = outcome.span.end.frame;
  const FrameNumber at = outcome.walk.at;
  Reasons reasons;
  switch (outcome.walk.stop) {
    case WalkBack::Stop::kFirstFrame:
      reasons = {Remark("it held from the first frame on")};
      break;
    case WalkBack::Stop::kPreviousEnd:
      reasons = {Remark("the one before ended here")};
      break;
    case WalkBack::Stop::kTooFarBack:
      reasons = {Remark("the rule reaches at most " + Seconds(rule.back_s) + " back")};
      break;
    case WalkBack::Stop::kSince:
      reasons =
          Change(rule.since, {.instance = instance, .frame = at + 1, .end = end}, true, depth);
      break;
    case WalkBack::Stop::kReceding:
    case WalkBack::Stop::kIdle:
      reasons = CutOfWalk(instance, outcome);
      break;
  }
  const bool later = outcome.walk.stop != WalkBack::Stop::kReceding &&
                     outcome.walk.stop != WalkBack::Stop::kIdle &&
                     begin > at + (outcome.walk.stop == WalkBack::Stop::kSince ? 1 : 0);
  if (!later || !approach) return reasons;
  const grammar::Dimension of_signal = NoteOf(past_.program(), approach->signal).dimension;
  const grammar::Dimension dimension = approach->motion == kNone
                                           ? grammar::Quotient(of_signal, grammar::kSeconds)
                                           : NoteOf(past_.program(), approach->motion).dimension;
  Reason moved = Remark(
      ClauseText(past_, instance, approach->motion == kNone ? approach->signal : approach->motion) +
          " moves from here on",
      "not slower than " + QuantityText(approach->speed, dimension));
  moved.mark = Mark::kTurned;
  reasons.insert(reasons.begin(), std::move(moved));
  return reasons;
}

Reasons EventReasons::BeginOrEndOfRest(InstanceId instance, FrameNumber frame, bool begins,
                                       int depth) {
  const RestOfRule& rule = past_.RuleOf(instance).As<RestOfRule>();
  Reasons reasons;
  const auto add = [&](int slot, bool truth) {
    const InstanceId target = past_.Referred(instance, slot);
    const bool holds = target != kNone && past_.Covering(target, frame) != nullptr;
    if (holds != truth) return;
    Reason reason = clauses_.Reference(instance, slot, frame, truth, FollowFrom(depth));
    if (!brief_ || reason.mark == Mark::kTurned) reasons.push_back(std::move(reason));
  };
  add(rule.whole, begins);
  for (const int other : rule.outside) add(other, !begins);
  return reasons;
}

// The bindings that begin or end here; of several that hold, others go on.
Reasons EventReasons::BeginOrEndOfAny(InstanceId instance, FrameNumber frame, bool end, int depth) {
  Reasons reasons;
  std::vector<InstanceId> members = past_.MembersOf(instance);
  std::sort(members.begin(), members.end(),
            [&](InstanceId a, InstanceId b) { return past_.EntitiesOf(a) < past_.EntitiesOf(b); });
  for (const InstanceId member : members) {
    for (const CandidateOutcome& outcome : past_.OutcomesOf(member)) {
      const FrameNumber boundary = end ? outcome.span.end.frame : outcome.span.begin.frame;
      if (!outcome.IsInterval() || boundary != frame) continue;
      const Rule& rule = past_.RuleOf(member);
      reasons.push_back(
          {.mark = Mark::kTurned,
           .what = Label(past_, member),
           .how = end ? "ended" : "began",
           .where = rule.form() == Form::kTouching ? "" : Source(rule.file, rule.place),
           .tick = past_.TickOf(frame),
           .because = FollowFrom(depth)(member, outcome, end)});
    }
  }
  return reasons;
}

bool EventReasons::ChooseParts(InstanceId instance, const CandidateOutcome& whole,
                               std::vector<const CandidateOutcome*>& chosen) {
  const auto& composition = past_.RuleOf(instance).As<grammar::ComposeRule>();
  if (composition.at_least > 0) return AllInside(instance, whole, chosen);
  const std::size_t part = chosen.size(), count = static_cast<std::size_t>(composition.count);
  if (part == count) return !composition.hull || Spans(chosen, whole);
  std::vector<const CandidateOutcome*> candidates;
  for (const int slot : composition.ChoicesFor(static_cast<int>(part))) {
    for (const CandidateOutcome& outcome : past_.OutcomesOf(past_.Referred(instance, slot)))
      candidates.push_back(&outcome);
  }
  for (const CandidateOutcome* candidate : candidates) {
    const CandidateOutcome& outcome = *candidate;
    const bool begins = composition.hull
                            ? outcome.span.begin.frame >= whole.span.begin.frame
                            : part > 0 || outcome.span.begin.frame == whole.span.begin.frame;
    const bool ends = composition.hull
                          ? outcome.span.end.frame <= whole.span.end.frame
                          : part + 1 < count || outcome.span.end.frame == whole.span.end.frame;
    if (!outcome.IsInterval() || !begins || !ends) continue;
    chosen.push_back(candidate);
    const auto ticks = [&](int i) {
      return grammar::Interval{chosen[i]->span.begin.tick, chosen[i]->span.end.tick};
    };
    const auto is_later = [part](int left, int right) {
      return std::max(left, right) != static_cast<int>(part);
    };
    const auto holds = [&](const grammar::ComposeRule::Clause& clause) {
      return is_later(clause.left, clause.right) ||
             clause.In([this](double seconds) { return past_.AtMostTicks(seconds); })
                 .Fit(ticks(clause.left), ticks(clause.right));
    };
    const auto is_absent = [&](const grammar::ComposeRule::Absence& absence) {
      if (is_later(absence.left, absence.right)) return true;
      const InstanceId absent = past_.Referred(instance, composition.parts[absence.part]);
      return std::ranges::none_of(past_.OutcomesOf(absent), [&](const CandidateOutcome& one) {
        return one.IsInterval() && std::max(one.span.begin.tick, ticks(absence.left).end) <
                                       std::min(one.span.end.tick, ticks(absence.right).begin);
      });
    };
    const bool fits = std::ranges::all_of(composition.clauses, holds) &&
                      std::ranges::all_of(composition.absences, is_absent);
    if (fits && ChooseParts(instance, whole, chosen)) return true;
    chosen.pop_back();
  }
  return false;
}

// From where the first of them begins to where the last one ends.
bool EventReasons::Spans(const std::vector<const CandidateOutcome*>& chosen,
                         const CandidateOutcome& whole) {
  return std::ranges::any_of(chosen,
                             [&](const CandidateOutcome* one) {
                               return one->span.begin.frame == whole.span.begin.frame;
                             }) &&
         std::ranges::any_of(chosen, [&](const CandidateOutcome* one) {
           return one->span.end.frame == whole.span.end.frame;
         });
}

// All intervals of a repetition, in their order.
bool EventReasons::AllInside(InstanceId instance, const CandidateOutcome& whole,
                             std::vector<const CandidateOutcome*>& chosen) {
  for (const int slot : past_.RuleOf(instance).As<grammar::ComposeRule>().parts) {
    for (const CandidateOutcome& outcome : past_.OutcomesOf(past_.Referred(instance, slot))) {
      if (outcome.IsInterval() && outcome.span.begin.frame >= whole.span.begin.frame &&
          outcome.span.end.frame <= whole.span.end.frame)
        chosen.push_back(&outcome);
    }
  }
  std::ranges::stable_sort(chosen, {},
                           [](const CandidateOutcome* one) { return one->span.begin.frame; });
  return !chosen.empty();
}

Reasons EventReasons::Parts(InstanceId instance, const CandidateOutcome& outcome, int depth) {
  std::vector<const CandidateOutcome*> chosen;
  Reasons reasons;
  if (!ChooseParts(instance, outcome, chosen)) return reasons;
  for (const CandidateOutcome* part : chosen) {
    Reason reason = Remark("part " + Label(past_, part->instance),
                           truth::IntervalText({part->span.begin.tick, part->span.end.tick},
                                               past_.entity_table().ticks_per_second));
    const bool begins = part->span.begin.frame == outcome.span.begin.frame &&
                        std::ranges::none_of(reasons, [](const Reason& other) {
                          return other.mark == Mark::kTurned;
                        });
    if (begins) reason.mark = Mark::kTurned;
    if (begins && depth < kMaxDepth) reason.because = Begin(part->instance, *part, depth + 1);
    reasons.push_back(std::move(reason));
  }
  return reasons;
}

Reasons EventReasons::Counted(InstanceId instance, const CandidateOutcome& outcome) {
  const Rule& rule = past_.RuleOf(instance);
  const Tick per_second = past_.entity_table().ticks_per_second;
  Reasons reasons;
  if (rule.lasting_s > 0) {
    reasons.push_back(Remark(
        "lasting " + Seconds(rule.lasting_s),
        "it lasted " + Duration(outcome.span.end.tick - outcome.span.begin.tick, per_second)));
  }
  if (rule.requirement != kNone) {
    const FrameNumber last = std::min(outcome.span.end.frame, past_.frames() - 1);
    const Viewpoint at{
        .instance = instance, .frame = last, .begin = outcome.span.begin.frame, .end = last};
    for (Reason& reason : clauses_.State(rule.requirement, at, true)) {
      reason.what = "requires " + reason.what;
      reasons.push_back(std::move(reason));
    }
  }
  if (const std::optional<FrameNumber> confirmed = ConfirmedAt(outcome)) {
    const InstanceId by = past_.Referred(instance, rule.confirmed_by);
    const InstanceId within = past_.Referred(instance, rule.confirmed_within);
    reasons.push_back(Remark(
        "confirmed by " + Label(past_, by),
        "it began at " + clauses_.Time(*confirmed) + ", while " + Label(past_, within) + " held"));
  }
  return reasons;
}

// Why it was not known at its end already.
Reasons EventReasons::Waited(InstanceId instance, const CandidateOutcome& outcome, int depth) {
  const Rule& rule = past_.RuleOf(instance);
  const Tick end = outcome.span.end.tick;
  Reasons reasons;
  if (outcome.decided <= end || depth >= kMaxDepth) return reasons;
  const auto* holds = rule.If<WhileRule>();
  if (holds != nullptr && holds->bridging_s > 0 && !outcome.span.open_end) {
    reasons.push_back(
        Remark(Label(past_, instance),
               "a gap of up to " + Seconds(holds->bridging_s) + " would have been bridged"));
  }
  if (rule.looks_around_s > 0 && !outcome.span.open_end) {
    reasons.push_back(Remark(Label(past_, instance), "a signal over a window looks " +
                                                         Seconds(rule.looks_around_s) + " ahead"));
  }
  if (const std::optional<FrameNumber> confirmed = ConfirmedAt(outcome)) {
    reasons.push_back(Remark(Label(past_, past_.Referred(instance, rule.confirmed_by)),
                             "had to begin, and did so at " + clauses_.Time(*confirmed)));
  }
  for (Reason& reason : WaitedFor(instance, outcome, depth)) reasons.push_back(std::move(reason));
  return reasons;
}

// How far back it may turn out to have held: it looks back itself, or begins with what does. 0: not
// at all.
double EventReasons::LooksBack_s(InstanceId instance) {
  const Rule& rule = past_.RuleOf(instance);
  if (const auto* looks_back = rule.If<UntilSinceRule>()) return looks_back->back_s;
  int begins_with = kNone;
  if (const auto* rest = rule.If<RestOfRule>()) begins_with = rest->whole;
  if (rule.form() == Form::kFromTo) begins_with = rule.opened_by;
  const InstanceId target = begins_with == kNone ? kNone : past_.Referred(instance, begins_with);
  return target == kNone ? 0 : LooksBack_s(target);
}

// What it refers to and was known at that very moment only, each once; or what might still have
// come in that time.
Reasons EventReasons::WaitedFor(InstanceId instance, const CandidateOutcome& outcome, int depth) {
  const Rule& rule = past_.RuleOf(instance);
  std::vector<InstanceId> targets = past_.MembersOf(instance);
  for (std::size_t slot = 0; slot < rule.references.size() && rule.form() != Form::kAny; ++slot) {
    targets.push_back(past_.Referred(instance, static_cast<int>(slot)));
  }
  std::erase(targets, kNone);
  Reasons reasons;
  bool waits = false;
  for (const InstanceId target : targets) {
    const std::vector<CandidateOutcome>& outcomes = past_.OutcomesOf(target);
    const auto only_then = [&](const CandidateOutcome& other) {
      return other.decided == outcome.decided &&
             (other.span.end.tick < other.decided || other.span.end.tick > outcome.span.end.tick);
    };
    const auto other = std::find_if(outcomes.begin(), outcomes.end(), only_then);
    if (other == outcomes.end()) continue;
    waits = true;
    if (!told_.insert(target).second) continue;
    const bool ends_then = other->span.end.tick == other->decided;
    Reason reason =
        Remark(Label(past_, target), ends_then ? "ended only then" : "was decided only then");
    reason.because = Waited(target, *other, depth + 1);
    if (reason.what == Label(past_, instance)) {
      std::ranges::move(reason.because, std::back_inserter(reasons));
    } else {
      reasons.push_back(std::move(reason));
    }
  }
  for (const InstanceId target : targets) {
    const double back_s = LooksBack_s(target);
    if (waits || back_s <= 0) continue;
    waits = true;
    reasons.push_back(
        Remark(Label(past_, target),
               "could still become true: it is known only at its end, and reaches back up to " +
                   Seconds(back_s)));
  }
  return reasons;
}

WhyEvent EventReasons::Explain(InstanceId instance, const CandidateOutcome& outcome, bool brief) {
  brief_ = brief;
  const Rule& rule = past_.RuleOf(instance);
  WhyEvent why{.event = Label(past_, instance),
               .where = Source(rule.file, rule.place),
               .interval = {outcome.span.begin.tick, outcome.span.end.tick},
               .decided = outcome.decided,
               .open_end = outcome.span.open_end,
               .began = Begin(instance, outcome),
               .ended = End(instance, outcome)};
  if (brief) return why;
  why.counted = Counted(instance, outcome);
  told_ = {instance};
  why.waited = Waited(instance, outcome, 0);
  return why;
}

}  // namespace prehend::show

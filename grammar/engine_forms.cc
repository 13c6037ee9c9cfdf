// SPDX-License-Identifier: Apache-2.0
// How each form of rule looks at one frame. The meaning of the forms is the table in
// docs/grammar-language.md.
#include <algorithm>

#include "grammar/engine.h"

namespace prehend::grammar {

void Engine::StepLane(Lane& lane) {
  if (RuleOf(lane).form == Form::kCompose) return StepCompose(lane);
  while (lane.next <= history_.now() && StepFrame(lane)) {
  }
  ResolvePending(lane);
  UpdateKnown(lane);
}

// One frame, if it can be decided.
bool Engine::StepFrame(Lane& lane) {
  bool decided = false;
  evaluator_.CalmDown();
  switch (RuleOf(lane).form) {
    case Form::kTouching:
    case Form::kCompose:
      break;
    case Form::kWhile:
      decided = StepWhile(lane, lane.next);
      break;
    case Form::kAny:
      decided = StepAny(lane, lane.next);
      break;
    case Form::kFromTo: {
      const bool was_open = lane.open;
      decided = StepFromTo(lane, lane.next);
      if (was_open && !lane.open)
        evaluator_.StirUp();  // what may begin the next one was not asked for, so nothing of it
                              // would wake
      break;
    }
    case Form::kUntilSince:
      decided = StepUntil(lane, lane.next);
      break;
    case Form::kRestOf:
      decided = StepRest(lane, lane.next);
      break;
  }
  if (decided) ++lane.next;
  return decided;
}

// Most looks find everything as it was: the lane rests on, and there is nothing to tell and nothing
// to wait for. If something is new, the frame may have been stepped, and the rest is left to
// StepLane.
bool Engine::LooksTheSame(Lane& lane) {
  const Rule& rule = RuleOf(lane);
  const FrameNumber now = history_.now();
  const auto settled = [&] {
    return lane.pending.empty() && (!lane.open || (lane.certain && !lane.in_gap));
  };
  const bool waits = rule.form == Form::kCompose ||
                     (rule.form == Form::kUntilSince && rule.referenced) || rule.within_s >= 0;
  if (lane.next != now || waits || !settled() || (rule.referenced && lane.told != Known(lane.open)))
    return false;
  const bool was_open = lane.open;
  if (!StepFrame(lane) || evaluator_.restless()) return false;
  return lane.open == was_open && settled() && (!lane.open || lane.begin.frame != now) &&
         lane.last_end != now;
}

bool Engine::StepWhile(Lane& lane, FrameNumber frame) {
  const Rule& rule = RuleOf(lane);
  const Evaluator::View view{lane, frame};
  if (rule.measured.whole && frame == history_.now() && CanMeasure(lane)) {
    return StepRun(lane, frame, Known(IsMeasured(lane)));
  }
  if (rule.second == kNone) return StepRun(lane, frame, evaluator_.Truth(rule.first, view));
  // Two thresholds: what has begun goes on until the second says so.
  const bool on = lane.open && !lane.in_gap;
  const Kleene goes_on = Not(evaluator_.Truth(rule.second, view));
  return StepRun(lane, frame, on ? goes_on : And(goes_on, evaluator_.Truth(rule.first, view)));
}

bool Engine::StepAny(Lane& lane, FrameNumber frame) {
  Kleene truth = Kleene::kFalse;
  for (const int member : lane.members) {
    truth = Or(truth, lanes_.TruthAt(member, frame));
    if (truth == Kleene::kTrue) break;
  }
  return StepRun(lane, frame, truth);
}

bool Engine::StepRun(Lane& lane, FrameNumber frame, Kleene truth) {
  if (truth == Kleene::kUnknown) return false;
  const Moment now = history_.At(frame);
  const Tick bridging = TicksOf(lane).bridging;
  if (truth == Kleene::kTrue) {
    if (lane.open && lane.in_gap && now.tick - lane.gap.tick > bridging && !Close(lane, lane.gap))
      return false;
    if (!lane.open && !Open(lane, frame)) return false;
    lane.in_gap = false;
  } else if (lane.open) {
    if (!lane.in_gap) {
      lane.in_gap = true;
      lane.gap = now;
    }
    // Later frames are later by a tick at least, so a gap of this length cannot be bridged any
    // more.
    if (now.tick - lane.gap.tick >= bridging) return Close(lane, lane.gap);
  }
  return true;
}

bool Engine::StepRest(Lane& lane, FrameNumber frame) {
  const Rule& rule = RuleOf(lane);
  const Evaluator::View view{lane, frame};
  const Kleene whole = evaluator_.Holds(rule.first, view);
  Kleene others = Kleene::kFalse;
  for (const int other : rule.outside) {
    if (whole != Kleene::kFalse) others = Or(others, evaluator_.Holds(other, view));
  }
  const Kleene truth = And(whole, Not(others));
  if (truth == Kleene::kUnknown) return false;
  // Two wholes that abut are two, and so are their rests.
  const bool new_whole =
      truth == Kleene::kTrue && evaluator_.Begins(rule.first, view) == Kleene::kTrue;
  if (lane.open && (truth == Kleene::kFalse || new_whole) && !Close(lane, history_.At(frame)))
    return false;
  return truth != Kleene::kTrue || lane.open || Open(lane, frame);
}

bool Engine::StepFromTo(Lane& lane, FrameNumber frame) {
  const Rule& rule = RuleOf(lane);
  const Evaluator::View view{lane, frame};
  const auto during = [&] {
    return rule.during == kNone ? Kleene::kTrue : evaluator_.Truth(rule.during, view);
  };
  if (lane.open && TicksOf(lane).within >= 0 && !MeetDeadline(lane, history_.At(frame)))
    return false;
  if (lane.open) {
    const Kleene closes = evaluator_.Truth(rule.second, view);
    if (closes == Kleene::kTrue && rule.absence) {
      Note(lane, Fate::Kind::kCame, {lane.begin, history_.At(frame)}, frame);
      lane.open = false;
    }
    if (closes == Kleene::kTrue) return !lane.open || Close(lane, history_.At(frame));
    const Kleene holds = during();
    if (holds == Kleene::kFalse && !rule.or_drop) return Close(lane, history_.At(frame));
    if (closes == Kleene::kUnknown || holds == Kleene::kUnknown) return false;
    if (holds == Kleene::kFalse) {
      Note(lane, Fate::Kind::kDropped, {lane.begin, history_.At(frame)}, frame);
      lane.open = false;
    }
    return true;
  }
  Kleene opens = evaluator_.Truth(rule.first, view);
  if (opens == Kleene::kFalse) return true;
  // What `during` and `to` say of @begin refers to this very frame.
  if (!evaluator_.CaptureAnchors(lane, frame)) return false;
  opens = And(opens, during());
  if (opens == Kleene::kFalse) return true;
  if (opens == Kleene::kUnknown) return false;
  // A begin that is an end at once is no interval.
  const Kleene closes = evaluator_.Truth(rule.second, view);
  if (closes == Kleene::kUnknown) return false;
  return closes == Kleene::kTrue || Open(lane, frame);
}

// What is open, but waits no longer: without the end that it waited for, it is dropped, or that is
// what it is about.
bool Engine::MeetDeadline(Lane& lane, Moment now) {
  const Rule& rule = RuleOf(lane);
  const Tick deadline = lane.begin.tick + TicksOf(lane).within;
  if (now.tick < deadline || (now.tick == deadline && !rule.absence)) return true;
  if (!rule.absence) {
    Note(lane, Fate::Kind::kTooLate, {lane.begin, {now.frame, deadline}}, now.frame);
    lane.open = false;
    return true;
  }
  const bool just_in_time = now.tick - lane.begin.tick <= TicksOf(lane).in_time;
  if (just_in_time && now.frame <= history_.now()) {
    const Kleene comes = evaluator_.Truth(rule.second, {lane, now.frame});
    if (comes != Kleene::kFalse) return comes == Kleene::kTrue;
  }
  return Close(lane, {now.frame, deadline});
}

bool Engine::StepUntil(Lane& lane, FrameNumber frame) {
  const Rule& rule = RuleOf(lane);
  const Kleene ends = evaluator_.Truth(rule.first, {lane, frame});
  if (ends == Kleene::kUnknown) return false;
  if (ends == Kleene::kTrue) {
    const WalkBack walk = ApproachBegin(lane, frame);
    const FrameNumber begin = walk.begin;
    if (begin == kNever) return false;
    const Fate::Kind kind = begin < frame ? Fate::Kind::kWalkedBack : Fate::Kind::kNothingBack;
    Note(lane, kind, {history_.At(begin), history_.At(frame)}, frame, walk);
    if (begin < frame) {
      if (!evaluator_.CaptureAnchors(lane, begin)) return false;
      lane.style = StyleAt(lane, begin);
      if (!Conclude(lane, {history_.At(begin), history_.At(frame)})) return false;
    }
    lane.last_end = lane.approach_from = frame;
  }
  if (!rule.referenced) return true;
  if (evaluator_.Truth(rule.second, {lane, frame}) == Kleene::kFalse)
    lane.approach_from = frame + 1;
  while (lane.approach_from < frame &&
         evaluator_.TooFarApart(rule.second, lane, lane.approach_from, frame)) {
    ++lane.approach_from;
  }
  return true;
}

// How fast it moves from this frame to the next, on which the signal falls by `way`.
std::optional<double> Engine::ApproachSpeed(Lane& lane, FrameNumber frame, FrameNumber end,
                                            double way) const {
  const Rule& rule = RuleOf(lane);
  if (rule.motion != kNone) return evaluator_.Number(rule.motion, {lane, frame + 1, end});
  return way / history_.Seconds(history_.At(frame + 1).tick - history_.At(frame).tick);
}

// Walks back from `end` to where the interval begins.
WalkBack Engine::ApproachBegin(Lane& lane, FrameNumber end) const {
  using Stop = WalkBack::Stop;
  const Rule& rule = RuleOf(lane);
  const Tick end_tick = history_.At(end).tick;
  const FrameNumber back = history_.FirstNotBefore(end_tick - TicksOf(lane).back);
  const FrameNumber earliest = std::max({back, lane.last_end, history_.first()});
  const Stop at_earliest = earliest == lane.last_end && earliest > 0 ? Stop::kPreviousEnd
                           : earliest == 0                           ? Stop::kFirstFrame
                                                                     : Stop::kTooFarBack;
  const WalkBack unknown{.begin = kNever};
  FrameNumber begin =
      end;  // the earliest frame of movement; if pauses do not count, the earliest frame
  FrameNumber turn = end;           // the movement that began from the farthest point
  std::optional<double> after = 0;  // the signal one frame later
  if (rule.approach != kNone) after = evaluator_.Number(rule.approach, {lane, end, end});
  if (!after) return unknown;
  double farthest = *after;
  FrameNumber last_progress = end;
  for (FrameNumber frame = end - 1; frame >= earliest; --frame) {
    const Evaluator::View view{lane, frame, end};
    const Kleene holds = evaluator_.Truth(rule.second, view);
    if (holds == Kleene::kUnknown) return unknown;
    if (holds == Kleene::kFalse) return {begin, Stop::kSince, frame};
    if (rule.approach == kNone) {
      begin = frame;
      continue;
    }
    // Read backwards, an approach moves away from its goal.
    const std::optional<double> here = evaluator_.Number(rule.approach, view);
    if (!here) return unknown;
    if (*here < farthest - rule.slack) return {turn, Stop::kReceding, frame};
    const std::optional<double> speed = ApproachSpeed(lane, frame, end, *here - *after);
    if (!speed) return unknown;
    if (*speed >= rule.speed) {
      last_progress = frame;
    } else if (rule.idle_s >= 0 &&
               history_.At(last_progress).tick - history_.At(frame).tick > TicksOf(lane).idle) {
      return {begin, Stop::kIdle, last_progress};
    }
    // The slow start of a movement belongs to it.
    const auto moves = [&](FrameNumber since) {
      return *speed >= rule.speed || (since == frame + 1 && *speed > rule.onset);
    };
    if (*here > farthest && moves(turn)) turn = frame;
    if (rule.idle_s < 0 || moves(begin)) begin = frame;
    farthest = std::max(farthest, *here);
    after = here;
  }
  return {begin, at_earliest, earliest};
}

}  // namespace prehend::grammar

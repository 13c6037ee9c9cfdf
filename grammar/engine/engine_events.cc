// SPDX-License-Identifier: Apache-2.0
// From a run of frames to an event: minimum duration, requirement, confirmation, and what is known
// of it meanwhile.
#include <algorithm>

#include "grammar/engine/engine.h"

namespace prehend::grammar {

// False while a value is not known that must be kept from here.
bool Engine::Open(Lane& lane, FrameNumber frame) {
  if (!RuleOf(lane).anchors.empty() && !evaluator_.CaptureAnchors(lane, frame)) return false;
  Begin(lane, frame);
  return true;
}

void Engine::Begin(Lane& lane, FrameNumber frame) {
  lane.open = true;
  lane.in_gap = false;
  lane.begin = history_.At(frame);
  lane.style = StyleAt(lane, frame);
}

// A hand that no frame has shown yet has no style.
int Engine::StyleOfHand(int entity, FrameNumber frame) const {
  const HandSample* hand = history_.Hand(entity, frame);
  return hand == nullptr ? kNoEntity : hand->look.style;
}

// False, with nothing changed, if it is not known yet whether the run is an interval.
bool Engine::Close(Lane& lane, Moment end, bool open_end) {
  if (!Conclude(lane, {lane.begin, end, open_end})) return false;
  lane.open = lane.in_gap = false;
  return true;
}

bool Engine::Conclude(Lane& lane, const Span& span) {
  const Rule& rule = RuleOf(lane);
  if (span.end.tick - span.begin.tick < TicksOf(lane).lasting) {
    Note(lane, Fate::Kind::kTooShort, span);
    return true;
  }
  if (rule.requirement != kNone) {
    const FrameNumber last = std::min(span.end.frame, history_.now());
    const Kleene required = evaluator_.Truth(rule.requirement, {lane, last, last});
    if (required == Kleene::kUnknown) return false;
    if (required == Kleene::kFalse) Note(lane, Fate::Kind::kRefused, span);
    if (required == Kleene::kFalse) return true;
  }
  Pending finished{.span = span, .style = lane.style, .next = span.end.frame};
  for (std::size_t i = 0; i < rule.attributes.size(); ++i) {
    const FrameNumber last = std::min(span.end.frame, history_.now());
    const std::optional<double> value =
        evaluator_.Number(rule.attributes[i].node, {lane, last, last});
    if (!value) return false;
    finished.attributes[i] = *value;
  }
  if (rule.confirmed_by != kNone) {
    lane.pending.push_back(finished);
  } else {
    Emit(lane, finished);
  }
  return true;
}

// An interval is confirmed when the other event begins at or after its end while the episode has
// held all the time.
void Engine::ResolvePending(Lane& lane) {
  const Rule& rule = RuleOf(lane);
  std::erase_if(lane.pending, [&](Pending& pending) {
    for (; pending.next <= history_.now(); ++pending.next) {
      const Evaluator::View view{lane, pending.next};
      const Kleene within = evaluator_.Holds(rule.confirmed_within, view);
      if (within == Kleene::kFalse)
        Note(lane, Fate::Kind::kUnconfirmed, pending.span, pending.next);
      if (within == Kleene::kFalse) return true;
      const Kleene begins = evaluator_.Begins(rule.confirmed_by, view);
      if (And(within, begins) == Kleene::kTrue) {
        Emit(lane, pending);
        return true;
      }
      if (within == Kleene::kUnknown || begins == Kleene::kUnknown) return false;
    }
    return false;
  });
}

void Engine::Emit(Lane& lane, const Pending& finished) {
  const Rule& rule = RuleOf(lane);
  const Span& span = finished.span;
  Note(lane, Fate::Kind::kInterval, span, rule.confirmed_by == kNone ? kNever : finished.next);
  if (rule.referenced) Keep(lane, span);
  if (!rule.part_of.empty()) TellCompositions(lane, span);
  if (!rule.printed) return;
  Event& event = out_->emplace_back();
  event.rule = lane.rule;
  event.roles = lane.entities;
  event.interval = {span.begin.tick, span.end.tick};
  event.decided = DecidedAt(lane, span);
  event.style = finished.style;
  event.open_end = span.open_end;
  event.attributes = finished.attributes;
}

// As long as somebody may ask about it.
void Engine::Keep(Lane& lane, const Span& span) {
  while (!lane.past.empty() && lane.past.front().end.frame < history_.first()) lane.past.PopFront();
  lane.past.PushBack() = span;
}

// A deadline that passes between two frames decides at once; the later frame only tells that time
// went on.
Tick Engine::DeadlineOf(const Span& span) const {
  const FrameNumber before = finishing_ ? history_.now() : history_.now() - 1;
  const bool just_passed = before >= history_.first() && span.end.tick > history_.At(before).tick;
  return just_passed ? span.end.tick : decided_;
}

bool Engine::RunIsCertain(const Lane& lane) const {
  const Rule& rule = RuleOf(lane);
  if (rule.requirement != kNone || rule.confirmed_by != kNone || rule.or_drop || rule.within_s >= 0)
    return false;
  const Tick earliest_end = lane.in_gap ? lane.gap.tick : history_.At(lane.next - 1).tick + 1;
  return earliest_end - lane.begin.tick >= TicksOf(lane).lasting;
}

void Engine::UpdateKnown(Lane& lane) {
  const Rule& rule = RuleOf(lane);
  lane.known = lane.next;
  if (lane.open) {
    lane.certain = RunIsCertain(lane);
    const FrameNumber certain_end = lane.in_gap ? lane.gap.frame : lane.next;
    lane.known = lane.certain ? certain_end : lane.begin.frame;
  }
  if (rule.form == Form::kUntilSince && rule.referenced && lane.next > history_.first()) {
    // A later interval ends after the last frame seen and reaches back no further than its rule
    // says.
    const Tick last = history_.At(lane.next - 1).tick;
    const FrameNumber reach = history_.FirstNotBefore(last + 1 - TicksOf(lane).back);
    lane.known = std::min(lane.next, std::max(lane.approach_from, reach));
  }
  for (const Pending& pending : lane.pending)
    lane.known = std::min(lane.known, pending.span.begin.frame);
}

// The last frames are decided, then what is open ends with the episode.
void Engine::FinishLane(Lane& lane, Moment end) {
  StepLane(lane);
  if (lane.open && TicksOf(lane).within >= 0) MeetDeadline(lane, end);
  if (lane.open && lane.in_gap) {
    Close(lane, lane.gap);
  } else if (lane.open && !RuleOf(lane).or_drop) {
    Close(lane, end, true);
  } else if (lane.open) {
    Note(lane, Fate::Kind::kUnfinished, {lane.begin, end});
  }
  ResolvePending(
      lane);  // a gap that nothing bridges any more ends an interval that others may have confirmed
  for (const Pending& pending : lane.pending)
    Note(lane, Fate::Kind::kUnconfirmed, pending.span, end.frame);
  lane.open = lane.in_gap = lane.awake = false;
  lane.pending.clear();
  lane.known = kNever;
}

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// From a run of frames to an event: minimum duration, requirement, confirmation, and what is known
// of it meanwhile.
#include <algorithm>

#include "grammar/engine/engine.h"

namespace prehend::grammar {

// False while a value is not known that must be kept from here.
bool Engine::Open(RuleInstance& instance, FrameNumber frame) {
  if (!RuleOf(instance).anchors.empty() && !evaluator_.CaptureAnchors(instance, frame))
    return false;
  Begin(instance, frame);
  return true;
}

void Engine::Begin(RuleInstance& instance, FrameNumber frame) {
  instance.open = true;
  instance.in_gap = false;
  instance.begin = history_.At(frame);
  instance.count = 0;
  instance.style = StyleAt(instance, frame);
}

// A hand that no frame has shown yet has no style.
int Engine::StyleOfHand(int entity, FrameNumber frame) const {
  const HandAtFrame* hand = history_.Hand(entity, frame);
  return hand == nullptr ? kNoEntity : hand->look.style;
}

// False, with nothing changed, if it is not known yet whether the run is an interval.
bool Engine::Close(RuleInstance& instance, Moment end, bool open_end) {
  if (!Conclude(instance, {instance.begin, end, open_end})) return false;
  instance.open = instance.in_gap = false;
  return true;
}

bool Engine::Conclude(RuleInstance& instance, const Span& span) {
  const Rule& rule = RuleOf(instance);
  if (span.end.tick - span.begin.tick < TicksOf(instance).lasting) {
    Note(instance, fate::TooShort{}, span);
    return true;
  }
  if (TicksOf(instance).IsTooLong(span.end.tick - span.begin.tick)) {
    Note(instance, fate::TooLong{}, span);
    return true;
  }
  if (const auto* holds = rule.If<WhileRule>();
      holds != nullptr && instance.count < holds->at_least) {
    Note(instance, fate::TooFew{instance.count}, span);
    return true;
  }
  if (rule.requirement != kNone) {
    const FrameNumber last = std::min(span.end.frame, history_.now());
    const Kleene required = evaluator_.Truth(rule.requirement, {instance, last, last});
    if (required == Kleene::kUnknown) return false;
    if (required == Kleene::kFalse) Note(instance, fate::Refused{}, span);
    if (required == Kleene::kFalse) return true;
  }
  Pending finished{.span = span, .style = instance.style, .next = span.end.frame};
  for (std::size_t i = 0; i < rule.attributes.size(); ++i) {
    const FrameNumber last = std::min(span.end.frame, history_.now());
    const std::optional<double> value =
        evaluator_.Number(rule.attributes[i].node, {instance, last, last});
    if (!value) return false;
    finished.attributes[i] = *value;
  }
  if (rule.confirmed_by != kNone) {
    instance.pending.push_back(finished);
  } else {
    Emit(instance, finished);
  }
  return true;
}

// An interval is confirmed when the other event begins at or after its end while the episode has
// held all the time.
void Engine::ResolvePending(RuleInstance& instance) {
  const Rule& rule = RuleOf(instance);
  std::erase_if(instance.pending, [&](Pending& pending) {
    for (; pending.next <= history_.now(); ++pending.next) {
      const Evaluator::View view{instance, pending.next};
      const Kleene within = evaluator_.Holds(rule.confirmed_within, view);
      if (within == Kleene::kFalse) Note(instance, fate::Unconfirmed{pending.next}, pending.span);
      if (within == Kleene::kFalse) return true;
      const Kleene begins = evaluator_.Begins(rule.confirmed_by, view);
      if (And(within, begins) == Kleene::kTrue) {
        Emit(instance, pending);
        return true;
      }
      if (within == Kleene::kUnknown || begins == Kleene::kUnknown) return false;
    }
    return false;
  });
}

void Engine::Emit(RuleInstance& instance, const Pending& finished) {
  const Rule& rule = RuleOf(instance);
  const Span& span = finished.span;
  Note(instance, fate::Interval{rule.confirmed_by == kNone ? kNever : finished.next}, span);
  if (rule.referenced) Keep(instance, span);
  if (!rule.part_of.empty()) NotifyCompositions(instance, span);
  if (!rule.printed) return;
  Event& event = out_->emplace_back();
  event.rule = instance.rule;
  event.roles = instance.entities;
  event.interval = {span.begin.tick, span.end.tick};
  event.decided = DecidedAt(instance, span);
  event.style = finished.style;
  event.open_end = span.open_end;
  event.attributes = finished.attributes;
}

// Keeps an interval as long as another rule may ask about it.
void Engine::Keep(RuleInstance& instance, const Span& span) {
  while (!instance.past.empty() && instance.past.front().end.frame < history_.first())
    instance.past.PopFront();
  instance.past.PushBack() = span;
  if (const auto* owners = instance.If<AnyState>()) instance.past.back().owner = owners->owner;
}

// A deadline between two frames decides at its own tick: the later frame only shows that time went
// on.
Tick Engine::DeadlineOf(const Span& span) const {
  const FrameNumber before = finishing_ ? history_.now() : history_.now() - 1;
  const bool just_passed = before >= history_.first() && span.end.tick > history_.At(before).tick;
  return just_passed ? span.end.tick : decided_;
}

// An open run that lasts long enough may still be given up for what comes or does not come.
bool Engine::MayComeToNothing(const RuleInstance& instance) const {
  const Rule& rule = RuleOf(instance);
  const auto* from_to = rule.If<FromToRule>();
  const auto* holds = rule.If<WhileRule>();
  return rule.requirement != kNone || rule.confirmed_by != kNone || rule.lasting_most_s >= 0 ||
         (holds != nullptr && instance.count < holds->at_least) ||
         (from_to != nullptr && (from_to->or_drop || from_to->within_s >= 0));
}

bool Engine::RunIsCertain(const RuleInstance& instance) const {
  return !MayComeToNothing(instance) && AtLeastLasts(instance) >= TicksOf(instance).lasting;
}

// How long the open run lasts, if it ends as soon as it can.
Tick Engine::AtLeastLasts(const RuleInstance& instance) const {
  const Tick earliest_end =
      instance.in_gap ? instance.gap.tick : history_.At(instance.next - 1).tick + 1;
  return earliest_end - instance.begin.tick;
}

void Engine::UpdateKnown(RuleInstance& instance) {
  const Rule& rule = RuleOf(instance);
  instance.known = instance.next;
  if (instance.open) {
    instance.certain = RunIsCertain(instance);
    const FrameNumber certain_end = instance.in_gap ? instance.gap.frame : instance.next;
    instance.known = instance.certain ? certain_end : instance.begin.frame;
    // What is too long is none, but what waits with `each` may take its place.
    const auto* from_to = instance.If<FromToState>();
    if (TicksOf(instance).IsTooLong(AtLeastLasts(instance)))
      instance.known = from_to == nullptr         ? instance.next
                       : from_to->waiting.empty() ? OldestNeeded(instance)
                                                  : from_to->waiting.front().frame;
  }
  if (rule.form() == Form::kUntilSince && rule.referenced && instance.next > history_.first()) {
    // A later interval ends after the last frame seen and reaches back no further than its rule
    // says.
    const Tick last = history_.At(instance.next - 1).tick;
    const FrameNumber reach = history_.FirstNotBefore(last + 1 - TicksOf(instance).back);
    instance.known =
        std::min(instance.next, std::max(instance.As<UntilSinceState>().approach_from, reach));
  }
  for (const Pending& pending : instance.pending)
    instance.known = std::min(instance.known, pending.span.begin.frame);
}

// The last frames are decided, then what is open ends with the episode.
void Engine::FinishInstance(RuleInstance& instance, Moment end) {
  StepInstance(instance);
  const auto* from_to = RuleOf(instance).If<FromToRule>();
  if (instance.open && TicksOf(instance).within >= 0) MeetDeadline(instance, end);
  if (instance.open && instance.in_gap) {
    Close(instance, instance.gap);
  } else if (instance.open && (from_to == nullptr || !from_to->or_drop)) {
    const Span last = EndOfParts(instance, end);
    Close(instance, last.end, last.open_end);
  } else if (instance.open) {
    Note(instance, fate::Unfinished{}, {instance.begin, end});
  }
  ResolvePending(instance);  // a gap that nothing bridges any more ends an interval that others may
                             // have confirmed
  for (const Pending& pending : instance.pending)
    Note(instance, fate::Unconfirmed{end.frame}, pending.span);
  instance.open = instance.in_gap = instance.awake = false;
  instance.pending.clear();
  instance.known = kNever;
}

}  // namespace prehend::grammar

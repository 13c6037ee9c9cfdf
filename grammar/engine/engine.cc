// SPDX-License-Identifier: Apache-2.0
#include "grammar/engine/engine.h"

#include <algorithm>

namespace prehend::grammar {
namespace {

bool Later(const auto& a, const auto& b) { return a.tick > b.tick; }

}  // namespace

Engine::Engine(std::shared_ptr<const Program> program, EntityTable entity_table)
    : program_(std::move(program)),
      entity_table_(std::move(entity_table)),
      entity_count_(static_cast<int>(entity_table_.entities.size())),
      history_(entity_table_),
      lanes_(*program_, entity_table_),
      evaluator_(*program_, entity_table_, history_, lanes_),
      thresholds_(program_->thresholds),
      recalls_touches_(program_->recalls_touches || program_->asks_touches),
      keeps_touches_(program_->asks_touches),
      grips_(entity_table_.entities.size(), thresholds_.OfGrip(0)),
      awake_(program_->events.size()) {
  for (const Rule& rule : program_->events) {
    rule_ticks_.push_back({.bridging = history_.AtMostTicks(rule.bridging_s),
                           .lasting = history_.AtLeastTicks(rule.lasting_s),
                           .idle = history_.AtMostTicks(rule.idle_s),
                           .back = history_.AtMostTicks(rule.back_s),
                           .within = rule.within_s < 0 ? -1
                                     : rule.absence    ? history_.AtLeastTicks(rule.within_s)
                                                       : history_.AtMostTicks(rule.within_s),
                           .in_time = history_.AtMostTicks(rule.within_s)});
    // A requirement or an attribute is asked for where the run ended, when its gap is too long.
    const double waits_s =
        rule.requirement == kNone && rule.attributes.empty() ? 0 : rule.bridging_s;
    longest_look_back_ = std::max(
        longest_look_back_, history_.AtLeastTicks(rule.back_s + rule.looks_around_s + waits_s));
  }
  lanes_.BindUnguarded();
  for (int i = 0; i < lanes_.size(); ++i) Wake(i);
  if (lanes_.TooMany()) error_ = lanes_.WhyTooMany();
}

void Engine::Wake(int index) {
  Lane& lane = lanes_[index];
  if (lane.awake || lane.rule == kNone) return;
  lane.awake = true;
  lane.next = lane.approach_from = std::max<FrameNumber>(history_.now(), 0);
  if (!lane.open || (lane.certain && !lane.in_gap)) lane.known = lane.next;
  awake_[lane.rule].push_back(index);
}

void Engine::WakeWatchers(const std::vector<Watch>& watchers) {
  for (const Watch& watch : watchers) {
    if (MayStir(lanes_[watch.lane])) Wake(watch.lane);
  }
}

// What is not open does not begin while its guard rests, whatever else happens.
bool Engine::MayStir(const Lane& lane) const {
  return lane.open || (MayBegin(lane) && !lanes_.GuardRests(lane));
}

// Something must be measured where this lane begins, and it is known. At the end of the episode
// touches are over.
bool Engine::CanMeasure(const Lane& lane) const {
  const MeasuredPart& part = RuleOf(lane).measured;
  return !part.is_empty() && !finishing_ &&
         (part.touch == kNone || lane.references[part.touch] != kNone);
}

// What must be so of a touch and of a grip is so now.
bool Engine::IsMeasured(const Lane& lane) const {
  const MeasuredPart& part = RuleOf(lane).measured;
  const int hand = part.hand == kNone ? kNoEntity : lane.entities[part.hand];
  if (part.touch == kNone) return part.grip.Fit(grips_[hand]);
  const Lane& touch = lanes_[lane.references[part.touch]];
  return IsMeasured(part, hand, touch,
                    part.first != kNone && touch.entities[0] != lane.entities[part.first]);
}

// A resting lane would find what it found before: what must be measured for it to begin is not, or
// nothing else matters and that is as it was.
bool Engine::SaysTheSame(const Lane& lane) const {
  if (!CanMeasure(lane)) return false;
  if (lane.open) return RuleOf(lane).measured.whole && IsMeasured(lane) == !lane.in_gap;
  return !IsMeasured(lane);
}

bool Engine::MomentMayCome(const Lane& lane) const {
  const Rule& rule = RuleOf(lane);
  if (rule.opened_by == kNone) return true;
  const int event = lane.references[rule.opened_by];
  if (event == kNone) return true;  // nobody would wake this lane, as it has not asked yet
  const FrameNumber now = history_.now();
  return (rule.opened_by_end ? lanes_.EndsAt(event, now) : lanes_.BeginsAt(event, now)) !=
         Kleene::kFalse;
}

// The truth of this lane is another one than in the frame before.
void Engine::Tell(Lane& lane) {
  if (!lane.dependents_made) {
    scratch_.clear();
    lanes_.MakeDependents(lane.index, scratch_);
    for (const int dependent : scratch_) Wake(dependent);
  }
  for (const Watcher& watcher : lane.watchers) {
    Lane& watching = lanes_[watcher.lane];
    if (watcher.opened) watching.moment = lane.told == Kleene::kUnknown ? kNever : history_.now();
    if (watching.awake) continue;
    if (watcher.instant != nullptr) {
      Measure(watching, watcher, lane);
    } else if (watching.open || MayBegin(watching)) {
      if (watching.open || watcher.guarded || !lanes_.GuardRests(watching)) Wake(watcher.lane);
    } else if (!lane.open && watcher.guarded) {
      // The guard has held up to the frame before; a moment here may still be told of.
      watcher.guarded_begin&& lane.told == Kleene::kFalse ? RestOn(watching) : Wake(watcher.lane);
    }
  }
}

void Engine::TellIfChanged(Lane& lane) {
  if (!RuleOf(lane).referenced) return;
  const FrameNumber now = history_.now();
  const Kleene truth = lanes_.TruthAt(lane.index, now);
  const bool at_an_edge = (lane.open && lane.begin.frame == now) ||
                          (!lane.past.empty() && (lane.past.back().end.frame == now ||
                                                  lane.past.back().begin.frame == now));
  if (truth == lane.told && !at_an_edge) return;
  lane.told = truth;
  Tell(lane);
}

void Engine::WakeAt(Tick tick, int lane) {
  alarms_.push_back({tick, lane});
  std::push_heap(alarms_.begin(), alarms_.end(), Later<Alarm, Alarm>);
}

void Engine::RingAlarms() {
  while (!alarms_.empty() && alarms_.front().tick <= decided_) {
    Wake(alarms_.front().lane);
    std::pop_heap(alarms_.begin(), alarms_.end(), Later<Alarm, Alarm>);
    alarms_.pop_back();
  }
}

// Every frame is decided, and the next one says the same unless something changes or an alarm
// rings. A form that is not listed here never rests while it is open.
bool Engine::MayRest(const Lane& lane) {
  const Rule& rule = RuleOf(lane);
  if (lane.next <= history_.now() || !lane.pending.empty() || evaluator_.restless()) return false;
  switch (rule.form) {
    case Form::kCompose:
      return true;
    case Form::kFromTo:
      // What must not come may still come at the deadline; what should have come is too late after
      // it.
      if (lane.open && TicksOf(lane).within >= 0) {
        WakeAt(lane.begin.tick + TicksOf(lane).within + (rule.absence ? 0 : 1), lane.index);
      }
      return true;
    case Form::kRestOf:
      return true;
    case Form::kUntilSince:
      return !rule.referenced || lane.approach_from > history_.now();
    case Form::kWhile:
    case Form::kAny:
      break;
    default:
      return !lane.open && lanes_.GuardRests(lane);
  }
  const bool time_makes_certain =
      rule.referenced && rule.requirement == kNone && rule.confirmed_by == kNone;
  if (lane.in_gap) {
    WakeAt(lane.gap.tick + TicksOf(lane).bridging, lane.index);
  } else if (lane.open && !lane.certain && time_makes_certain) {
    WakeAt(lane.begin.tick + TicksOf(lane).lasting - 1, lane.index);
  }
  return true;
}

void Engine::Rest(Lane& lane) {
  lane.awake = false;
  lane.resting_since = history_.now();
  if (!lane.open || (lane.certain && !lane.in_gap)) lane.known = kNever;
  if (!lane.open) Retire(lane);
}

void Engine::StepRule(int rule) {
  std::erase_if(awake_[rule], [&](int index) {
    Lane& lane = lanes_[index];
    if (LooksTheSame(lane)) {
      Rest(lane);
      return true;
    }
    StepLane(lane);
    TellIfChanged(lane);
    if (MayRest(lane)) {
      Rest(lane);
      return true;
    }
    // What ended at a gap may be asked for what it was like there when it is known that nothing
    // bridges the gap.
    const FrameNumber needed = lane.in_gap ? lane.gap.frame : lane.next;
    oldest_needed_ = std::min(oldest_needed_, needed);
    for (const Pending& pending : lane.pending)
      oldest_needed_ = std::min(oldest_needed_, pending.next);
    if (RuleOf(lane).uses_looks) oldest_look_needed_ = std::min(oldest_look_needed_, needed);
    return false;
  });
}

// Keeps what a walk back may reach, and two frames more for differences between frames.
void Engine::ForgetThePast() {
  if (fates_ != nullptr) return;
  const auto reach = [&](FrameNumber needed, FrameNumber before) {
    const Tick earliest = history_.At(std::max(needed, history_.first())).tick - longest_look_back_;
    FrameNumber frame = std::max(before, history_.first());
    while (frame + 2 <= history_.now() && history_.At(frame + 2).tick < earliest) ++frame;
    return frame;
  };
  first_needed_ = reach(oldest_needed_, first_needed_);
  first_look_needed_ = reach(oldest_look_needed_, first_look_needed_);
  history_.Forget(first_needed_, first_look_needed_);
}

// Lanes that have rested for so long that nobody can ask about what they were before.
void Engine::FreeLanes() {
  while (!retirees_.empty() && fates_ == nullptr && retirees_.front().since < history_.first()) {
    Lane& lane = lanes_[retirees_.front().lane];
    retirees_.PopFront();
    lane.retiring = false;
    if (lane.awake || lane.open) continue;  // retires when it rests again
    scratch_.assign(1, lane.index);
    while (!scratch_.empty()) FreeOrRetire(scratch_);
  }
}

// Of what only a freed lane asked about, most has rested for as long: with it goes the whole chain.
void Engine::FreeOrRetire(std::vector<int>& candidates) {
  Lane& lane = lanes_[candidates.back()];
  candidates.pop_back();
  if (lane.rule == kNone || lane.awake || lane.open || lane.retiring) return;
  if (lane.resting_since >= history_.first()) {
    Retire(lane);
  } else if (CanBeFreed(lane)) {
    lanes_.Free(lane.index, candidates);
  }
}

bool Engine::CanBeFreed(const Lane& lane) const {
  const Form form = RuleOf(lane).form;
  if (form != Form::kTouching && !lanes_.GuardRests(lane)) return false;
  // Compositions remember; and whoever asks about this lane must be woken by it, unless it is made
  // to be.
  const auto remembers = [](const std::vector<Span>& spans) { return !spans.empty(); };
  const auto depends = [&](const Watcher& watcher) {
    return RuleOf(lanes_[watcher.lane]).form != Form::kAny;
  };
  return std::none_of(lane.parts.begin(), lane.parts.end(), remembers) && !MayOverlap(lane) &&
         std::none_of(lane.watchers.begin(), lane.watchers.end(), depends);
}

// A first part is on its way that may begin before the end of the last composition, which has to be
// remembered then.
bool Engine::MayOverlap(const Lane& lane) const {
  if (RuleOf(lane).form != Form::kCompose) return false;
  const int index = lanes_.Find(lane, RuleOf(lane).composition.parts.front());
  if (index == kNone) return false;
  const Lane& first = lanes_[index];
  return first.open || first.awake || !first.pending.empty() ||
         RuleOf(first).form == Form::kCompose;
}

}  // namespace prehend::grammar

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
      instances_(*program_, entity_table_),
      evaluator_(*program_, entity_table_, history_, instances_),
      thresholds_(program_->thresholds),
      recalls_touches_(program_->recalls_touches || program_->asks_touches),
      keeps_touches_(program_->asks_touches),
      grips_(entity_table_.entities.size(), thresholds_.OfGrip(0)),
      awake_(program_->rules.size()) {
  for (const Rule& rule : program_->rules) {
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
  instances_.BindUnguarded();
  for (int i = 0; i < instances_.size(); ++i) Wake(i);
  if (instances_.TooMany()) error_ = instances_.WhyTooMany();
}

void Engine::Wake(int index) {
  RuleInstance& instance = instances_[index];
  if (instance.awake || instance.rule == kNone) return;
  instance.awake = true;
  instance.next = instance.approach_from = std::max<FrameNumber>(history_.now(), 0);
  if (!instance.open || (instance.certain && !instance.in_gap)) instance.known = instance.next;
  awake_[instance.rule].push_back(index);
}

void Engine::WakeWatchers(const std::vector<Watch>& watchers) {
  for (const Watch& watch : watchers) {
    if (MayWake(instances_[watch.instance])) Wake(watch.instance);
  }
}

// What is not open does not begin while its guard rests, whatever else happens.
bool Engine::MayWake(const RuleInstance& instance) const {
  return instance.open || (MayBegin(instance) && !instances_.GuardRests(instance));
}

// Something must be measured where this instance begins, and it is known. At the end of the episode
// touches are over.
bool Engine::CanMeasure(const RuleInstance& instance) const {
  const MeasuredPart& part = RuleOf(instance).measured;
  return !part.is_empty() && !finishing_ &&
         (part.touch == kNone || instance.references[part.touch] != kNone);
}

// What must be so of a touch and of a grip is so now.
bool Engine::IsMeasured(const RuleInstance& instance) const {
  const MeasuredPart& part = RuleOf(instance).measured;
  const int hand = part.hand == kNone ? kNoEntity : instance.entities[part.hand];
  if (part.touch == kNone) return part.grip.Fit(grips_[hand]);
  const RuleInstance& touch = instances_[instance.references[part.touch]];
  return IsMeasured(part, hand, touch,
                    part.first != kNone && touch.entities[0] != instance.entities[part.first]);
}

// A resting instance would find what it found before: what must be measured for it to begin is not,
// or nothing else matters and that is as it was.
bool Engine::SaysTheSame(const RuleInstance& instance) const {
  if (!CanMeasure(instance)) return false;
  if (instance.open)
    return RuleOf(instance).measured.whole && IsMeasured(instance) == !instance.in_gap;
  return !IsMeasured(instance);
}

bool Engine::MomentMayCome(const RuleInstance& instance) const {
  const Rule& rule = RuleOf(instance);
  if (rule.opened_by == kNone) return true;
  const int event = instance.references[rule.opened_by];
  if (event == kNone) return true;  // nobody would wake this instance, as it has not asked yet
  const FrameNumber now = history_.now();
  return (rule.opened_by_end ? instances_.EndsAt(event, now) : instances_.BeginsAt(event, now)) !=
         Kleene::kFalse;
}

// The truth of this instance is another one than in the frame before.
void Engine::NotifyWatchers(RuleInstance& instance) {
  if (!instance.dependents_made) {
    scratch_.clear();
    instances_.MakeDependents(instance.index, scratch_);
    for (const int dependent : scratch_) Wake(dependent);
  }
  for (const Watcher& watcher : instance.watchers) {
    RuleInstance& watching = instances_[watcher.instance];
    if (watcher.opened)
      watching.moment = instance.reported == Kleene::kUnknown ? kNever : history_.now();
    if (watching.awake) continue;
    if (watcher.instant != nullptr) {
      Measure(watching, watcher, instance);
    } else if (watching.open || MayBegin(watching)) {
      if (watching.open || watcher.guarded || !instances_.GuardRests(watching))
        Wake(watcher.instance);
    } else if (!instance.open && watcher.guarded) {
      // The guard has held up to the frame before; a moment here may still be told of.
      watcher.guarded_begin&& instance.reported == Kleene::kFalse ? RestOn(watching)
                                                                  : Wake(watcher.instance);
    }
  }
}

void Engine::NotifyIfChanged(RuleInstance& instance) {
  if (!RuleOf(instance).referenced) return;
  const FrameNumber now = history_.now();
  const Kleene truth = instances_.TruthAt(instance.index, now);
  const bool at_an_edge = (instance.open && instance.begin.frame == now) ||
                          (!instance.past.empty() && (instance.past.back().end.frame == now ||
                                                      instance.past.back().begin.frame == now));
  if (truth == instance.reported && !at_an_edge) return;
  instance.reported = truth;
  NotifyWatchers(instance);
}

void Engine::WakeAt(Tick tick, int instance) {
  alarms_.push_back({tick, instance});
  std::push_heap(alarms_.begin(), alarms_.end(), Later<Alarm, Alarm>);
}

void Engine::RingAlarms() {
  while (!alarms_.empty() && alarms_.front().tick <= decided_) {
    Wake(alarms_.front().instance);
    std::pop_heap(alarms_.begin(), alarms_.end(), Later<Alarm, Alarm>);
    alarms_.pop_back();
  }
}

// Every frame is decided, and the next one says the same unless something changes or an alarm
// rings. A form that is not listed here never rests while it is open.
bool Engine::MayRest(const RuleInstance& instance) {
  const Rule& rule = RuleOf(instance);
  if (instance.next <= history_.now() || !instance.pending.empty() || evaluator_.depends_on_time())
    return false;
  switch (rule.form) {
    case Form::kCompose:
      return true;
    case Form::kFromTo:
      // What must not come may still come at the deadline; what should have come is too late after
      // it.
      if (instance.open && TicksOf(instance).within >= 0) {
        WakeAt(instance.begin.tick + TicksOf(instance).within + (rule.absence ? 0 : 1),
               instance.index);
      }
      return true;
    case Form::kRestOf:
      return true;
    case Form::kUntilSince:
      return !rule.referenced || instance.approach_from > history_.now();
    case Form::kWhile:
    case Form::kAny:
      break;
    default:
      return !instance.open && instances_.GuardRests(instance);
  }
  const bool time_makes_certain =
      rule.referenced && rule.requirement == kNone && rule.confirmed_by == kNone;
  if (instance.in_gap) {
    WakeAt(instance.gap.tick + TicksOf(instance).bridging, instance.index);
  } else if (instance.open && !instance.certain && time_makes_certain) {
    WakeAt(instance.begin.tick + TicksOf(instance).lasting - 1, instance.index);
  }
  return true;
}

void Engine::Rest(RuleInstance& instance) {
  instance.awake = false;
  instance.resting_since = history_.now();
  if (!instance.open || (instance.certain && !instance.in_gap)) instance.known = kNever;
  if (!instance.open) QueueIdle(instance);
}

void Engine::StepRule(int rule) {
  std::erase_if(awake_[rule], [&](int index) {
    RuleInstance& instance = instances_[index];
    if (LooksTheSame(instance)) {
      Rest(instance);
      return true;
    }
    StepInstance(instance);
    NotifyIfChanged(instance);
    if (MayRest(instance)) {
      Rest(instance);
      return true;
    }
    // What ended at a gap may be asked for what it was like there when it is known that nothing
    // bridges the gap.
    const FrameNumber needed = instance.in_gap ? instance.gap.frame : instance.next;
    oldest_needed_ = std::min(oldest_needed_, needed);
    for (const Pending& pending : instance.pending)
      oldest_needed_ = std::min(oldest_needed_, pending.next);
    if (RuleOf(instance).uses_looks) oldest_look_needed_ = std::min(oldest_look_needed_, needed);
    return false;
  });
}

// Keeps what a walk back may reach, and two frames more for differences between frames.
void Engine::ForgetThePast() {
  if (log_ != nullptr) return;
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

// RuleInstances that have rested for so long that nobody can ask about what they were before.
void Engine::FreeInstances() {
  while (!idle_queue_.empty() && log_ == nullptr && idle_queue_.front().since < history_.first()) {
    RuleInstance& instance = instances_[idle_queue_.front().instance];
    idle_queue_.PopFront();
    instance.idle_queued = false;
    if (instance.awake || instance.open) continue;  // retires when it rests again
    scratch_.assign(1, instance.index);
    while (!scratch_.empty()) FreeOrQueue(scratch_);
  }
}

// Of what only a freed instance asked about, most has rested for as long: with it goes the whole
// chain.
void Engine::FreeOrQueue(std::vector<int>& candidates) {
  RuleInstance& instance = instances_[candidates.back()];
  candidates.pop_back();
  if (instance.rule == kNone || instance.awake || instance.open || instance.idle_queued) return;
  if (instance.resting_since >= history_.first()) {
    QueueIdle(instance);
  } else if (CanBeFreed(instance)) {
    instances_.Free(instance.index, candidates);
  }
}

bool Engine::CanBeFreed(const RuleInstance& instance) const {
  const Form form = RuleOf(instance).form;
  if (form != Form::kTouching && !instances_.GuardRests(instance)) return false;
  // Compositions remember; and whoever asks about this instance must be woken by it, unless it is
  // made to be.
  const auto remembers = [](const std::vector<Span>& spans) { return !spans.empty(); };
  const auto depends = [&](const Watcher& watcher) {
    return RuleOf(instances_[watcher.instance]).form != Form::kAny;
  };
  return std::none_of(instance.parts.begin(), instance.parts.end(), remembers) &&
         !MayOverlap(instance) &&
         std::none_of(instance.watchers.begin(), instance.watchers.end(), depends);
}

// A first part is on its way that may begin before the end of the last composition, which has to be
// remembered then.
bool Engine::MayOverlap(const RuleInstance& instance) const {
  if (RuleOf(instance).form != Form::kCompose) return false;
  const int index = instances_.Find(instance, RuleOf(instance).composition.parts.front());
  if (index == kNone) return false;
  const RuleInstance& first = instances_[index];
  return first.open || first.awake || !first.pending.empty() ||
         RuleOf(first).form == Form::kCompose;
}

}  // namespace prehend::grammar

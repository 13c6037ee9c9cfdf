// SPDX-License-Identifier: Apache-2.0
// What a frame says, and the end of the episode. A whole frame is compared with the one before it;
// from there on there are only changes.
#include <algorithm>
#include <tuple>

#include "grammar/engine/engine.h"

namespace prehend::grammar {
namespace {

// All but the trigger.
bool SamePose(const HandSample& a, const HandAtFrame& b) {
  const auto& [entity, trigger, style, ahead_W, collision_spheres] = a;
  return style == b.look.style && ahead_W == b.look.ahead_W &&
         std::ranges::equal(collision_spheres, b.collision_spheres);
}

// As the roles of an instance name the two.
TouchSample SampleOf(const Touch& touch, bool swapped, FrameNumber frame) {
  const auto& [a, b, up_on_a, up_on_b, force_n, speed_m_per_s, p_W_m, nhat_BA_W, sets] = touch;
  return {.frame = frame,
          .up = swapped ? std::array{up_on_b, up_on_a} : std::array{up_on_a, up_on_b},
          .force_n = force_n,
          .vertical_speed_m_per_s = speed_m_per_s,
          .p_W_m = p_W_m,
          .nhat_W = swapped ? -nhat_BA_W : nhat_BA_W,
          .sensor_sets = sets};
}

}  // namespace

// All look-ups in one loop, so that they overlap in the processor instead of waiting for each
// other.
void Engine::LookUp(std::span<const Touch> touches) {
  contacts_.clear();
  for (const Touch& touch : touches) {
    const InstanceId instance = instances_.FindTouch(touch.a, touch.b);
    if (instance != kNone) instances_.Fetch(instance);
    contacts_.push_back(instance);
  }
}

// Likewise.
void Engine::FetchLooks(std::span<const EntityChange> changes) const {
  for (const EntityChange& change : changes) {
    history_.Fetch(change.entity);
    instances_.FetchWatchers(change.entity);
  }
  for (const EntityChange& change : changes) {
    history_.FetchSamples(change.entity);
    instances_.FetchWatching(change.entity);
  }
}

void Engine::Advance(const Frame& frame, std::vector<Event>& out) {
  if (!BeginFrame(frame, out)) return;
  for (std::size_t i = 0; i < frame.entities.size(); ++i) {
    const int entity = static_cast<int>(i);
    if (!SameFacts(frame.entities[i], history_.Look(entity, history_.now())))
      Look(entity, frame.entities[i]);
  }
  for (const HandSample& hand : frame.hands) Look(hand);
  ApplyContacts(frame.touches);
  // A touch that this frame does not show has ended.
  for (std::size_t i = touching_.size(); i-- > 0;) Part(touching_[i]);
  EndFrame();
}

void Engine::AdvanceBy(const FrameChanges& changes, std::vector<Event>& out) {
  if (BringsNothing(changes) && error_.empty() && !finishing_) return PassBy(changes.tick);
  if (!BeginFrame(changes, out)) return;
  FetchLooks(changes.entities);
  for (const EntityChange& change : changes.entities) Look(change.entity, change.look);
  for (const HandSample& hand : changes.hands) Look(hand);
  ApplyContacts(changes.touches);
  for (const ContactEnd& contact_end : changes.contact_ends) {
    const InstanceId index = instances_.FindTouch(contact_end.a, contact_end.b);
    if (index != kNone && instances_[index].open) Part(index);
  }
  EndFrame();
}

template <typename AnyFrame>
bool Engine::BeginFrame(const AnyFrame& frame, std::vector<Event>& out) {
  if (!error_.empty() || finishing_) return false;
  std::string_view why_not = WhyNoTick(frame.tick, history_);
  if (why_not.empty()) why_not = WhyNotWatchable(frame, entity_count_);
  if (!why_not.empty()) {
    error_ = why_not;
    return false;
  }
  LookUp(frame.touches);
  out_ = &out;
  first_new_ = out.size();
  decided_ = frame.tick;
  history_.BeginFrame(frame.tick);
  past_.BeginFrame(history_.now());
  alarms_.Sound(decided_, [this](InstanceId instance) { Wake(instance); });
  return true;
}

// Nobody has anything to look at in this frame. It is kept for those who look back over it.
void Engine::PassBy(Tick tick) {
  constexpr FrameNumber kFramesBetweenForgetting = 16;
  if (const std::string_view why_not = WhyNoTick(tick, history_); !why_not.empty()) {
    error_ = why_not;
    return;
  }
  history_.BeginFrame(tick);
  if (history_.now() % kFramesBetweenForgetting != 0) return;
  past_.BeginFrame(history_.now());
  Forget();
  turn_ = -1;
}

void Engine::EndFrame() {
  for (const RuleId rule : program_->schedule) {
    turn_ = 2 * turns_[rule];
    if (!ahead_[rule].empty()) LookAhead(rule);
    if (some_may_rest_ && !may_rest_[rule].empty()) LetFollowersRest(rule);
    if (!awake_[rule].empty()) StepRule(rule);
  }
  some_may_rest_ = false;
  Forget();
  turn_ = -1;
  if (instances_.TooMany()) error_ = instances_.WhyTooMany();
  SortNewEvents();
}

void Engine::Forget() {
  if (log_ != nullptr) return;
  turn_ = 2 * static_cast<int>(turns_.size());  // everybody has had it
  past_.NeedHeld([this](const RememberedPast::Held& held) { return IsHeld(held); },
                 [this](const RememberedPast::Held& held) { return HeldFrom(held); });
  past_.Forget(history_);
  idle_.FreeOld();
}

void Engine::SortNewEvents() {
  const auto before = [](const Event& a, const Event& b) {
    return std::tie(a.decided, a.interval.begin, a.rule, a.roles) <
           std::tie(b.decided, b.interval.begin, b.rule, b.roles);
  };
  const auto first = out_->begin() + static_cast<std::ptrdiff_t>(first_new_);
  if (!std::is_sorted(first, out_->end(), before)) std::sort(first, out_->end(), before);
  out_ = nullptr;
}

void Engine::Finish(Tick end, std::vector<Event>& out) {
  if (!error_.empty() || finishing_ || history_.now() < 0) return;
  finishing_ = true;
  history_.Complete();
  out_ = &out;
  first_new_ = out.size();
  // The episode's last frame belongs to it, so its end is later.
  const Moment last{history_.now() + 1,
                    std::clamp(end, history_.At(history_.now()).tick + 1, kLatestTick + 1)};
  decided_ = last.tick;
  for (const InstanceId touching : touching_) CloseTouch(instances_[touching], last);
  // What rests is decided; if it is open, it ends now.
  for (InstanceId i(0); i < instances_.end_id(); ++i) {
    RuleInstance& instance = instances_[i];
    if (instance.rule != kNone && instance.waits) StopWaiting(instance);
    if (instance.rule == kNone || instance.awake || !instance.open) continue;
    Wake(i);
    instance.next = history_.now() + 1;
  }
  for (const RuleId rule : program_->schedule) {
    for (const InstanceId instance : awake_[rule]) FinishInstance(instances_[instance], last);
    awake_[rule].clear();
  }
  awake_count_ = 0;
  NoteUndecidedEnds();
  SortNewEvents();
}

// Ends that nothing led to, and that were not known to be any when that was seen.
void Engine::NoteUndecidedEnds() {
  for (const UndecidedEnd& end : undecided_ends_) {
    RuleInstance& instance = instances_[end.instance];
    const NodeId until = RuleOf(instance).As<UntilSinceRule>().until;
    if (evaluator_.Truth(until, {instance, end.frame}) != Kleene::kTrue) continue;
    const Moment at = history_.At(end.frame);
    Note(instance, fate::NothingBack{}, {at, at});
  }
}

void Engine::Look(int entity, const EntitySample& look) {
  const bool gets_on = history_.SetSample(entity, look, FirstLook(entity));
  WakeWatchers(entity, instances_.PoseWatchers(entity), gets_on);
}

void Engine::Look(const HandSample& hand) {
  const HandAtFrame* before = history_.Hand(hand.entity, history_.now());
  const bool same_grip = before != nullptr && before->look.trigger == hand.trigger;
  const bool same_pose = before != nullptr && SamePose(hand, *before);
  if (same_grip && same_pose) return;
  const ThresholdSet crossed = thresholds_.OfGrip(hand.trigger);
  const ThresholdSet changed =
      before == nullptr ? ~ThresholdSet{0} : kAnyChange | (crossed ^ before->crossed_thresholds);
  history_.SetHand(hand, crossed, FirstLook(hand.entity));
  grips_[hand.entity] = crossed;
  for (const Watch& watch : instances_.GripWatchers(hand.entity)) {
    const RuleInstance& instance = instances_[watch.instance];
    if (same_grip || instance.awake || (RuleOf(instance).watches_grips & changed) == 0) continue;
    if (MayWake(instance) && !SaysTheSame(instance)) Wake(watch.instance);
  }
  WakeWatchers(hand.entity, instances_.PoseWatchers(hand.entity), true);
}

void Engine::ApplyContacts(std::span<const Touch> touches) {
  const FrameNumber now = history_.now();
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Touch& touch = touches[i];
    const InstanceId index =
        contacts_[i] != kNone
            ? contacts_[i]
            : instances_.Ensure(kTouchingRule, {touch.a, touch.b, kNoEntity, kNoEntity});
    if (index == kNone) continue;
    RuleInstance& instance = instances_[index];
    auto& state = instance.As<TouchingState>();
    if (state.touched == now) continue;  // said twice
    state.touched = now;
    const bool swapped = instance.entities[0] != touch.a;
    const ThresholdSet crossed = thresholds_.OfTouch(
        swapped ? touch.up_on_b : touch.up_on_a, swapped ? touch.up_on_a : touch.up_on_b,
        touch.normal_force_n, touch.vertical_speed_m_per_s, touch.sensor_sets);
    const ThresholdSet changed = crossed ^ state.crossed_thresholds;
    if (instance.open &&
        (keeps_touches_ ? SampleOf(touch, swapped, now).Says(state.touches.back()) : changed == 0))
      continue;
    state.crossed_thresholds = crossed;
    if (recalls_touches_) Keep(instance, touch, swapped);
    if (instance.open) {
      NotifyOfThresholds(instance, changed | kAnyChange);
    } else {
      BeginTouch(instance);
    }
  }
}

// Who asks how two touch has both in its roles, and holds the looks of both while it waits.
void Engine::Keep(RuleInstance& instance, const Touch& touch, bool swapped) {
  auto& touching = instance.As<TouchingState>();
  const FrameNumber first = std::max(FirstLook(touch.a), FirstLook(touch.b));
  ForgetSamples(touching.crossings, first);
  touching.crossings.PushBack() = {history_.now(), touching.crossed_thresholds};
  if (!keeps_touches_) return;
  ForgetSamples(touching.touches, first);
  touching.touches.PushBack() = SampleOf(touch, swapped, history_.now());
}

void Engine::BeginTouch(RuleInstance& touching) {
  touching.open = touching.certain = true;
  touching.begin = history_.At(history_.now());
  touching.As<TouchingState>().place = touching_.size();
  touching_.push_back(touching.index);
  touching.reported = Kleene::kTrue;
  if (touching.followed) TellFollowers(touching);
  NotifyWatchers(touching);
}

// The two touch as before, but measured values crossed these thresholds.
void Engine::NotifyOfThresholds(const RuleInstance& touch, ThresholdSet changed) {
  for (const Watcher& watcher : touch.watchers) {
    if ((watcher.thresholds & changed) == 0) continue;
    RuleInstance& watching = instances_[watcher.instance];
    if (watching.awake) continue;
    if (watcher.kind == Watcher::Kind::kMeasured) {
      Measure(watching, watcher, touch);
    } else if (!SaysTheSame(watching) && MayWake(watching)) {
      Wake(watcher.instance);
    }
  }
}

// Everything else that a resting instance asks for is known already: hands are looked at before
// touches, and a frame contains each touch once. So if something changed, its interval begins or
// ends at this frame.
void Engine::BeginOrEnd(RuleInstance& instance) {
  const Moment now = history_.At(history_.now());
  if (instance.open) {
    Close(instance, now);
    RestOn(instance);
  } else {
    Begin(instance, now.frame);
    instance.certain = TicksOf(instance).lasting == 0;
  }
  instance.known = kNever;
  instance.reported = Known(instance.open);
  if (instance.followed) TellFollowers(instance);
  NotifyWatchers(instance);
}

void Engine::Part(InstanceId touching) {
  RuleInstance& instance = instances_[touching];
  const auto& state = instance.As<TouchingState>();
  if (state.touched == history_.now()) return;
  CloseTouch(instance, history_.At(history_.now()));
  touching_[state.place] = touching_.back();
  instances_[touching_.back()].As<TouchingState>().place = state.place;
  touching_.pop_back();
  instance.reported = Kleene::kFalse;
  if (instance.followed) TellFollowers(instance);
  NotifyWatchers(instance);
  RestOn(instance);
}

void Engine::CloseTouch(RuleInstance& instance, Moment end) {
  const Span span{.begin = instance.begin, .end = end, .open_end = finishing_};
  Keep(instance, span);
  if (!RuleOf(instance).part_of.empty()) NotifyCompositions(instance, span);
  instance.open = false;
}

}  // namespace prehend::grammar

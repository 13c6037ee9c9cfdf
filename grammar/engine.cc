// SPDX-License-Identifier: Apache-2.0
#include "grammar/engine.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace prehend::grammar {
namespace {

// Far enough from the limits of a Tick that times can be added and subtracted.
constexpr Tick kLatestTick = 1'000'000'000'000'000;

void SortEvents(std::vector<Event>::iterator begin, std::vector<Event>::iterator end) {
  std::sort(begin, end, [](const Event& a, const Event& b) {
    return std::tie(a.decided, a.interval.begin, a.rule, a.roles) < std::tie(b.decided, b.interval.begin, b.rule, b.roles);
  });
}

}  // namespace

Engine::Engine(std::shared_ptr<const Program> program, Cast cast)
    : program_(std::move(program)),
      cast_(std::move(cast)),
      history_(cast_),
      lanes_(*program_, cast_),
      evaluator_(*program_, cast_, history_, lanes_),
      awake_(program_->events.size()) {
  for (const Rule& rule : program_->events) {
    rule_ticks_.push_back({.bridging = history_.AtMostTicks(rule.bridging_s),
                           .lasting = history_.AtLeastTicks(rule.lasting_s),
                           .idle = history_.AtMostTicks(rule.idle_s),
                           .back = history_.AtMostTicks(rule.back_s)});
    longest_look_back_ = std::max(longest_look_back_, history_.AtLeastTicks(rule.back_s + rule.looks_around_s));
  }
  lanes_.BindUnguarded();
  for (int i = 0; i < lanes_.size(); ++i) {
    if (RuleOf(lanes_[i]).guard == kNone && RuleOf(lanes_[i]).form != Form::kTouching) Wake(i);
  }
  if (lanes_.TooMany()) error_ = "more bindings than this monitor can watch; give the roles narrower classes";
}

std::string Engine::WhyNotWatchable(const Frame& frame) const {
  if (frame.entities.size() != cast_.entities.size()) return "a frame shows another number of entities than the cast";
  if (frame.tick > kLatestTick || frame.tick < -kLatestTick) return "a frame's tick is too large";
  if (history_.now() >= 0 && frame.tick <= history_.At(history_.now()).tick) return "the frames are not in order of time";
  const int count = static_cast<int>(cast_.entities.size());
  int last_hand = kNobody;
  for (const HandLook& hand : frame.hands) {
    if (hand.entity < 0 || hand.entity >= count) return "a frame shows a hand that is not in the cast";
    if (hand.entity <= last_hand) return "a frame shows a hand twice, or its hands are not in the order of the cast";
    last_hand = hand.entity;
  }
  for (const Touch& touch : frame.touches) {
    if (touch.a < 0 || touch.a >= touch.b || touch.b >= count) return "a frame shows a touch of somebody not in the cast";
  }
  return {};
}

void Engine::Advance(const Frame& frame, std::vector<Event>& out) {
  if (!error_.empty() || finishing_) return;
  error_ = WhyNotWatchable(frame);
  if (!error_.empty()) return;
  out_ = &out;
  const auto first_new = static_cast<std::ptrdiff_t>(out.size());
  history_.Push(frame);
  decided_ = frame.tick;
  oldest_needed_ = oldest_look_needed_ = history_.now();
  WatchTouches(frame);
  for (const int rule : program_->schedule) StepRule(rule);
  ForgetThePast();
  SortEvents(out.begin() + first_new, out.end());
  out_ = nullptr;
}

void Engine::Finish(Tick end, std::vector<Event>& out) {
  if (!error_.empty() || finishing_ || history_.now() < 0) return;
  finishing_ = true;
  history_.Complete();
  out_ = &out;
  const auto first_new = static_cast<std::ptrdiff_t>(out.size());
  // The episode's last frame belongs to it, so its end is later.
  const Moment last{history_.now() + 1, std::clamp(end, history_.At(history_.now()).tick + 1, kLatestTick + 1)};
  decided_ = last.tick;
  EndTouches(last, true);
  for (const int rule : program_->schedule) {
    for (const int lane : awake_[rule]) FinishLane(lanes_[lane], last);
    awake_[rule].clear();
  }
  SortEvents(out.begin() + first_new, out.end());
  out_ = nullptr;
}

void Engine::WatchTouches(const Frame& frame) {
  for (const Touch& touch : frame.touches) {
    const Binding pair = {touch.a, touch.b, kNobody, kNobody};
    int index = lanes_.Find(kTouchingRule, pair);
    if (index == kNone) index = lanes_.Ensure(kTouchingRule, pair);
    if (index == kNone) continue;
    Lane& lane = lanes_[index];
    const bool swapped = lane.entities[0] != touch.a;
    lane.touches.PushBack() = {.frame = history_.now(),
                               .up = {swapped ? touch.up_on_b : touch.up_on_a, swapped ? touch.up_on_a : touch.up_on_b},
                               .force_n = touch.normal_force_n,
                               .sensor_sets = touch.sensor_sets};
    if (!lane.awake) {
      lane.awake = lane.open = lane.certain = true;
      lane.known = kNever;
      lane.begin = history_.At(history_.now());
      awake_[kTouchingRule].push_back(index);
    }
    lane.next = history_.now() + 1;
    StirDependents(lane);
  }
  if (lanes_.TooMany()) error_ = "more bindings than this monitor can watch; give the roles narrower classes";
  EndTouches(history_.At(history_.now()), false);
}

// A touch that this frame does not show has ended.
void Engine::EndTouches(Moment end, bool all) {
  std::erase_if(awake_[kTouchingRule], [&](int index) {
    Lane& lane = lanes_[index];
    if (!all && lane.next == end.frame + 1) return false;
    std::erase_if(lane.past, [&](const Span& past) { return past.end.frame < history_.first(); });
    lane.past.push_back({lane.begin, end});
    lane.awake = lane.open = false;
    return true;
  });
}

void Engine::Wake(int index) {
  Lane& lane = lanes_[index];
  if (lane.awake) return;
  lane.awake = true;
  lane.next = lane.known = lane.approach_from = std::max<FrameNumber>(history_.now(), 0);
  awake_[lane.rule].push_back(index);
}

void Engine::StirDependents(const Lane& lane) {
  for (const int dependent : lane.dependents) {
    Wake(dependent);
    lanes_[dependent].stirred = history_.now();
  }
}

// Nothing is true, open or undecided, and the guard says that it stays so.
bool Engine::AtRest(const Lane& lane) const {
  const Rule& rule = RuleOf(lane);
  if (rule.form == Form::kCompose) return lane.next > history_.now();
  if (rule.guard == kNone || lane.stirred == history_.now() || lane.open || !lane.pending.empty()) return false;
  return lane.next > history_.now() && lane.known > history_.now();
}

void Engine::StepRule(int rule) {
  std::erase_if(awake_[rule], [&](int index) {
    Lane& lane = lanes_[index];
    if (lane.next <= history_.now() || !lane.pending.empty()) StepLane(lane);
    if (rule != kTouchingRule && AtRest(lane)) {
      lane.awake = false;
      return true;
    }
    if (rule != kTouchingRule) StirDependents(lane);
    oldest_needed_ = std::min(oldest_needed_, lane.next);
    for (const Pending& pending : lane.pending) oldest_needed_ = std::min(oldest_needed_, pending.next);
    if (RuleOf(lane).uses_looks) oldest_look_needed_ = std::min(oldest_look_needed_, lane.next);
    return false;
  });
}

// Keeps what a walk back may reach, and two frames more for differences between frames.
void Engine::ForgetThePast() {
  const auto reach = [&](FrameNumber frame) {
    return std::max(history_.first(), history_.FirstNotBefore(history_.At(frame).tick - longest_look_back_) - 2);
  };
  const FrameNumber ticks = reach(std::max(oldest_needed_, history_.first()));
  const FrameNumber looks = reach(std::max(oldest_look_needed_, history_.first()));
  history_.Forget(ticks, looks);
  for (const int index : awake_[kTouchingRule]) {
    Ring<TouchSample>& touches = lanes_[index].touches;
    while (!touches.empty() && touches.front().frame < looks) touches.PopFront();
  }
}

}  // namespace prehend::grammar

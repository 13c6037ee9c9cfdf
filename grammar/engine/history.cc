// SPDX-License-Identifier: Apache-2.0
// Samples are stored where they change; binary search finds the one that holds at a frame.
#include "grammar/engine/history.h"

#include <algorithm>
#include <cmath>

namespace prehend::grammar {
namespace {

constexpr double kRounding = 1e-6;  // of a product of seconds and ticks per second
constexpr double kMaxTracedTicks = 1e15;

}  // namespace

History::History(const EntityTable& entity_table)
    : ticks_per_second_(static_cast<double>(entity_table.ticks_per_second)),
      looks_(entity_table.entities.size()),
      hand_of_entity_(entity_table.entities.size(), -1) {}

void History::BeginFrame(Tick tick) {
  ticks_.PushBack() = tick;
  ++count_;
}

void History::SetSample(int entity, const EntitySample& look, FrameNumber first) {
  RingBuffer<PoseAtFrame>& samples = looks_[entity].samples;
  ForgetSamples(samples, first);
  if (samples.empty() && now() > 0) samples.PushBack() = {};  // what it was before anybody said
  PoseAtFrame& sample = samples.PushBack();
  sample.frame = now();
  sample.look = look;
  looks_[entity].GiveBack();
}

void History::SetHand(const HandSample& look, std::uint64_t crossed_thresholds, FrameNumber first) {
  int& index = hand_of_entity_[look.entity];
  if (index < 0) {
    index = static_cast<int>(hands_.size());
    hands_.emplace_back();
  }
  RingBuffer<HandAtFrame>& samples = hands_[index].samples;
  ForgetSamples(samples, first);
  HandAtFrame& sample = samples.PushBack();
  sample.frame = now();
  sample.look = look;
  sample.collision_spheres.assign(look.collision_spheres.begin(), look.collision_spheres.end());
  sample.look.collision_spheres = {};
  sample.crossed_thresholds = crossed_thresholds;
  hands_[index].GiveBack();
}

void History::Forget(FrameNumber ticks, FrameNumber looks) {
  while (ticks_.size() > 2 && first() < ticks) ticks_.PopFront();
  first_look_ = std::max(first_look_, looks);
}

FrameNumber History::FirstNotBefore(Tick tick) const {
  std::size_t low = 0;
  std::size_t high = ticks_.size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (ticks_[middle] < tick) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return first() + static_cast<FrameNumber>(low);
}

FrameNumber History::LastNotAfter(Tick tick) const {
  const FrameNumber next = FirstNotBefore(tick);
  const bool here = next <= now() && At(next).tick == tick;
  return here ? next : std::max(first(), next - 1);
}

Tick History::AtMostTicks(double seconds) const {
  return static_cast<Tick>(
      std::floor(std::min(seconds * ticks_per_second_, kMaxTracedTicks) + kRounding));
}

Tick History::AtLeastTicks(double seconds) const {
  return static_cast<Tick>(
      std::ceil(std::min(seconds * ticks_per_second_, kMaxTracedTicks) - kRounding));
}

}  // namespace prehend::grammar

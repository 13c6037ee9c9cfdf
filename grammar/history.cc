// SPDX-License-Identifier: Apache-2.0
#include "grammar/history.h"

#include <algorithm>
#include <cmath>

namespace prehend::grammar {
namespace {

constexpr double kRounding = 1e-6;  // of a product of seconds and ticks per second
constexpr double kMostTicks = 1e15;

// The last sample at or before `frame`; the newest is asked for most. Samples are sorted by frame.
template <typename Sample>
const Sample& SampleAt(const Ring<Sample>& samples, FrameNumber frame) {
  if (samples.back().frame <= frame) return samples.back();
  std::size_t low = 0;
  std::size_t high = samples.size();
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (samples[middle].frame <= frame ? low : high) = middle;
  }
  return samples[low];
}

template <typename Sample>
void ForgetSamples(Ring<Sample>& samples, FrameNumber frame) {
  while (samples.size() > 1 && samples[1].frame <= frame) samples.PopFront();
}

bool SameRest(const EntityLook& a, const EntityLook& b) {
  return a.asleep && b.asleep && a.p_WB_m == b.p_WB_m && a.q_WB.coeffs() == b.q_WB.coeffs();
}

}  // namespace

History::History(const Cast& cast)
    : ticks_per_second_(static_cast<double>(cast.ticks_per_second)),
      looks_(cast.entities.size()),
      hand_of_entity_(cast.entities.size(), -1) {}

void History::Push(const Frame& frame) {
  ticks_.PushBack() = frame.tick;
  for (std::size_t i = 0; i < frame.entities.size(); ++i) {
    const EntityLook& look = frame.entities[i];
    if (!looks_[i].empty() && SameRest(looks_[i].back().look, look)) continue;
    looks_[i].PushBack() = {count_, look};
  }
  for (const HandLook& hand : frame.hands) {
    int& index = hand_of_entity_[hand.entity];
    if (index < 0) {
      index = static_cast<int>(hand_samples_.size());
      hand_samples_.emplace_back();
    }
    HandSample& sample = hand_samples_[index].PushBack();
    sample.frame = count_;
    sample.look = hand;
    sample.feelers.assign(hand.feelers.begin(), hand.feelers.end());
    sample.look.feelers = {};
  }
  ++count_;
}

void History::Forget(FrameNumber ticks, FrameNumber looks) {
  while (ticks_.size() > 2 && first() < ticks) ticks_.PopFront();
  for (Ring<LookSample>& samples : looks_) ForgetSamples(samples, looks);
  for (Ring<HandSample>& samples : hand_samples_) ForgetSamples(samples, looks);
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
  return static_cast<Tick>(std::floor(std::min(seconds * ticks_per_second_, kMostTicks) + kRounding));
}

Tick History::AtLeastTicks(double seconds) const {
  return static_cast<Tick>(std::ceil(std::min(seconds * ticks_per_second_, kMostTicks) - kRounding));
}

const EntityLook& History::Look(int entity, FrameNumber frame) const {
  return SampleAt(looks_[entity], frame).look;
}

const HandSample* History::Hand(int entity, FrameNumber frame) const {
  const int index = hand_of_entity_[entity];
  return index < 0 ? nullptr : &SampleAt(hand_samples_[index], frame);
}

}  // namespace prehend::grammar

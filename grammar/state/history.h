// SPDX-License-Identifier: Apache-2.0
// The recent past, by frame number: ticks of frames, looks of entities and hands. A look is stored
// only when it changed, so what is at rest takes no space and no time however long the past is
// kept. Tested by tests/grammar/state/history_test.cc
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/span.h"
#include "grammar/state/ring_buffer.h"

namespace prehend::grammar {

/// What a hand was like from one frame on.
struct HandAtFrame {
  FrameNumber frame = 0;
  HandSample look;  ///< its own span is empty, see `collision_spheres`
  std::vector<CollisionSphere> collision_spheres;
  std::uint64_t crossed_thresholds = 0;  ///< of the grammar, by its grip
};

/// The last sample at or before `frame`, or the first one; the newest is asked for most. Samples
/// are sorted by frame, and there is one.
template <typename Sample>
const Sample& SampleAt(const RingBuffer<Sample>& samples, FrameNumber frame) {
  const FrameNumber newest = samples.back().frame;
  if (newest <= frame) return samples.back();
  // One sample per frame at most: what changes all the time is so far before the newest.
  const std::size_t before = static_cast<std::size_t>(newest - frame) + 1;
  std::size_t low = samples.size() > before ? samples.size() - before : 0;
  if (samples[low].frame == frame) return samples[low];
  std::size_t high = samples.size();
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (samples[middle].frame <= frame ? low : high) = middle;
  }
  return samples[low];
}

/// Of the first sample after `frame`; kNever if there is none.
template <typename Sample>
FrameNumber FirstAfter(const RingBuffer<Sample>& samples, FrameNumber frame) {
  if (samples.empty() || samples.back().frame <= frame) return kNever;
  if (samples.size() == 1 || samples[samples.size() - 2].frame <= frame)
    return samples.back().frame;
  const auto at_most = static_cast<std::size_t>(samples.back().frame - frame);
  std::size_t low = samples.size() > at_most ? samples.size() - at_most : 0;
  std::size_t high = samples.size() - 1;  // it is one of these
  while (low < high) {
    if (samples[low].frame > frame) return samples[low].frame;
    const std::size_t middle = low + (high - low) / 2;
    if (samples[middle].frame > frame) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return samples[low].frame;
}

/// Drops what only frames before `frame` need.
template <typename Sample>
void ForgetSamples(RingBuffer<Sample>& samples, FrameNumber frame) {
  while (samples.size() > 1 && samples[1].frame <= frame) samples.PopFront();
}

/// How something looked, where it changed. A steady load stops allocating; what was needed once is
/// given back.
template <typename Sample>
struct Looks {
  RingBuffer<Sample> samples;
  std::uint32_t most = 0;   ///< samples at once
  std::uint32_t count = 0;  ///< of samples; both since they were looked at last
  bool was_lost = false;    ///< in one of them, ever

  /// After each new sample. Halves the memory when a quarter of it was enough for four times as
  /// many samples as fit into it.
  void GiveBack() {
    constexpr std::size_t kSmall = 8;
    most = std::max(most, static_cast<std::uint32_t>(samples.size()));
    if (++count < 4 * samples.capacity()) return;
    if (samples.capacity() > kSmall && most <= samples.capacity() / 4) samples.Halve();
    most = count = 0;
  }
};

/// A ball of this radius around its origin holds the entity and its bounding box.
double BoundOf_m(const EntityInfo& entity);

class History {
 public:
  explicit History(const EntityTable& entity_table);
  /// Call before the first frame if Way_m() or Bound_m() will be asked for.
  void MeasureWays(const EntityTable& entity_table);

  /// A new frame in which everything looks as before, until it is said otherwise.
  void BeginFrame(Tick tick);
  /// Forgets what only frames before `first` need. Whether its way grew, or nobody asks for that.
  bool SetSample(int entity, const EntitySample& look, FrameNumber first);
  void SetHand(const HandSample& look, std::uint64_t crossed_thresholds, FrameNumber first);

  /// Forgets ticks of frames before `ticks`. Looks that only frames before `looks` need may be
  /// forgotten.
  void Forget(FrameNumber ticks, FrameNumber looks);
  FrameNumber first_look() const { return first_look_; }

  /// No more frames will come.
  void Complete() { complete_ = true; }
  bool complete() const { return complete_; }

  /// Number of the newest frame; -1 before the first.
  FrameNumber now() const { return count_ - 1; }
  FrameNumber first() const { return count_ - static_cast<FrameNumber>(ticks_.size()); }
  Moment At(FrameNumber frame) const {
    return {frame, ticks_[static_cast<std::size_t>(frame - first())]};
  }
  /// The first remembered frame at or after `tick`; now() + 1 if there is none.
  FrameNumber FirstNotBefore(Tick tick) const;
  /// The last remembered frame at or before `tick`; the first one if there is none.
  FrameNumber LastNotAfter(Tick tick) const;

  const EntitySample& Look(int entity, FrameNumber frame) const {
    return looks_[entity].samples.empty() ? not_seen_yet_
                                          : SampleAt(looks_[entity].samples, frame).look;
  }
  /// Prefetches what SetSample() needs, in two steps.
  void Fetch(int entity) const { __builtin_prefetch(&looks_[entity]); }
  void FetchSamples(int entity) const { looks_[entity].samples.FetchNext(); }
  /// Whether some frame said that it is not tracked.
  bool WasLost(int entity) const { return looks_[entity].was_lost; }
  /// Null if this entity is no hand.
  const HandAtFrame* Hand(int entity, FrameNumber frame) const {
    const int index = hand_of_entity_[entity];
    return index < 0 ? nullptr : &SampleAt(hands_[index].samples, frame);
  }
  /// The first frame after this one in which the entity looks different; kNever if it does not.
  FrameNumber NextChange(int entity, FrameNumber after) const {
    const FrameNumber look = FirstAfter(looks_[entity].samples, after);
    const int hand = hand_of_entity_[entity];
    return hand < 0 ? look : std::min(look, FirstAfter(hands_[hand].samples, after));
  }
  /// How far the entity has moved so far, without its trembling: between two frames no point of it
  /// within kArm_m or Bound_m() of its origin gets farther than the difference and Tremble_m(), nor
  /// does it turn by more than that per kArm_m. Where it is lost or found it counts as far. Of
  /// a hand this holds for its collision spheres, too.
  double Way_m(int entity) const { return ways_m_[entity].way_m; }
  /// 0 as long as it has never moved.
  double Tremble_m(int entity) const { return ways_m_[entity].moved ? 2 * kTremble_m : 0; }
  static constexpr double kArm_m = 2.5;
  /// It lies in a ball of this radius around its origin.
  double Bound_m(int entity) const { return bounds_m_[entity]; }
  bool Shows(int hand) const { return hand_of_entity_[hand] >= 0; }
  double Seconds(Tick ticks) const { return static_cast<double>(ticks) / ticks_per_second_; }
  /// Whole ticks such that comparing differences of ticks gives the same as comparing seconds.
  Tick AtMostTicks(double seconds) const;
  Tick AtLeastTicks(double seconds) const;

 private:
  struct PoseAtFrame {
    FrameNumber frame = 0;
    EntitySample look;
  };

  /// As long as it stays near a place, it trembles, and has no way.
  struct Way {
    double way_m = 0;
    EntitySample place;
    bool moved = false;
    std::vector<CollisionSphere> surface_B = {};  ///< of a hand, as seen from it
  };
  static constexpr double kTremble_m = 0.005;

  void Move(int entity, const EntitySample& to);
  void MoveSurface(int hand, const std::vector<CollisionSphere>& to);
  double StepOf(int entity, const EntitySample& from, const EntitySample& to) const;

  double ticks_per_second_;
  FrameNumber count_ = 0;
  FrameNumber first_look_ = 0;
  bool complete_ = false;
  RingBuffer<Tick> ticks_;
  EntitySample not_seen_yet_;
  std::vector<Looks<PoseAtFrame>> looks_;  // by entity
  std::vector<Way> ways_m_;                // likewise, if anybody asks
  std::vector<double> bounds_m_;           // likewise: it lies in such a ball around its origin
  std::vector<Looks<HandAtFrame>> hands_;  // by hand, in order of first sight
  std::vector<int> hand_of_entity_;        // index into hands_ or -1
};

}  // namespace prehend::grammar

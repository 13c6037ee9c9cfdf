// SPDX-License-Identifier: Apache-2.0
// An imperfect tracker of a hand's motion: it samples the hand at a fixed rate, adds noise, loses
// samples and delivers them late. Between samples the tracked target moves evenly to the newest
// sample and waits there. Everything follows from a seed. Tested by
// tests/physics/motion/tracker_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>

#include "physics/base/random.h"
#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

class Tracker {
 public:
  /// The target rests at `start` until the first sample arrives.
  Tracker(const TrackerSettings& settings, int rate_hz, std::uint64_t seed,
          const TargetState& start);

  /// The tracked target of the next tick, where `truth` is the true target. Call once per tick.
  TargetState Follow(const TargetState& truth);

 private:
  struct Sample {
    std::int64_t arrives_tick = 0;
    Pose X_WH;
    double trigger = 0;
  };

  Sample TakeSample(const TargetState& truth);
  bool IsDropped();
  void StartToward(const Sample& sample);

  TrackerSettings settings_;
  int rate_hz_;
  std::int64_t latency_ticks_;
  std::int64_t approach_ticks_;  ///< duration of the motion to a sample
  Random random_;
  Eigen::Vector3d tremor_phase_rad_;
  bool losing_ = false;
  std::int64_t tick_ = 0;
  std::deque<Sample> in_transit_;
  TargetState from_, to_;        ///< the target's present motion
  std::int64_t begun_tick_ = 0;  ///< begin of that motion
  TargetState now_;
};

}  // namespace prehend::physics

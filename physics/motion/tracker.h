// SPDX-License-Identifier: Apache-2.0
// What an imperfect tracker makes of a hand's motion: it looks at the hand now and then, with
// noise, loses looks, and tells them late. Between looks the tracked target goes evenly to the
// newest one, and then waits there. All of it follows from a seed. Tested by
// tests/physics/motion/tracker_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>

#include "physics/motion/trajectory.h"
#include "physics/scene/random.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

class Tracker {
 public:
  /// The target rests at `start` before the first look arrives.
  Tracker(const TrackerSettings& settings, int rate_hz, std::uint64_t seed,
          const TargetState& start);

  /// The tracked target of the next tick, in which the true one is `truth`. To be called once a
  /// tick.
  TargetState Follow(const TargetState& truth);

 private:
  struct Look {
    std::int64_t arrives_tick = 0;
    Pose X_WH;
    double trigger = 0;
  };

  Look LookAt(const TargetState& truth);
  bool IsDropped();
  void StartToward(const Look& look);

  TrackerSettings settings_;
  int rate_hz_;
  std::int64_t latency_ticks_;
  std::int64_t approach_ticks_;  ///< that a look is approached for
  Random random_;
  Eigen::Vector3d tremor_phase_rad_;
  bool losing_ = false;
  std::int64_t tick_ = 0;
  std::deque<Look> under_way_;
  TargetState from_, to_;        ///< the target's present approach
  std::int64_t begun_tick_ = 0;  ///< of that approach
  TargetState now_;
};

}  // namespace prehend::physics

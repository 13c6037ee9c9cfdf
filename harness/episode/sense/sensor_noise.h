// SPDX-License-Identifier: Apache-2.0
// What imperfect sensors make of a frame: poses with noise, touches that are not seen, frames that
// are lost. Every random number follows from the seed, the tick and what is measured, so it does
// not matter which frames were looked at before. Tested by
// tests/harness/episode/sense/sensor_noise_test.cc
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/base/random.h"

namespace prehend::episode {

/// Who touches whom: the order in which touches are kept.
inline std::pair<int, int> PairOf(const grammar::Touch& touch) { return {touch.a, touch.b}; }

class SensorNoise {
 public:
  /// `measured`: for each entity whether its pose is measured; the others are where they are.
  SensorNoise(const scenario::SensorSettings& settings, std::vector<bool> measured);

  /// Whether the frame of this tick never arrives.
  bool Loses(grammar::Tick tick) const;

  /// The frame as sensed, as changes since the one before. Valid until the next call.
  grammar::FrameChanges Show(const grammar::Frame& truth);
  /// All of the last one. Valid until the next call.
  grammar::Frame Shown() const { return {tick_, entities_, hands_, touches_}; }

 private:
  /// How a measured pose is off.
  struct Offset {
    Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  };

  physics::Random At(grammar::Tick tick, std::uint64_t channel) const;
  Offset OffsetOf(grammar::Tick tick, int entity) const;
  void ShowPoses(const grammar::Frame& truth);
  void ShowTouches(const grammar::Frame& truth);

  scenario::SensorSettings settings_;
  std::vector<bool> measured_;
  grammar::Tick tick_ = -1;
  std::vector<grammar::EntitySample> entities_;
  std::vector<grammar::EntityChange> entity_changes_;
  std::vector<grammar::HandSample> hands_;
  std::vector<std::vector<grammar::CollisionSphere>> collision_spheres_;  ///< per hand
  std::vector<grammar::Touch> touches_, before_;
  std::vector<grammar::ContactEnd> contact_ends_;
};

}  // namespace prehend::episode

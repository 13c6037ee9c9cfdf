// SPDX-License-Identifier: Apache-2.0
// Snapshot -> Frame: what the grammar observes, whole or as changes. Contact points become touches
// of pairs; links become collision spheres and sensor sets. This knows geometry and no events.
// Sleeping bodies and the touches between them are not read again, so they cost no time. What
// imperfect sensors make of a frame: poses with noise, touches that are not seen, frames that are
// lost. Every random number follows from the seed, the tick and what is measured, so it does not
// matter which frames were looked at before. Tested by tests/harness/episode/sense/sensing_test.cc
// and tests/harness/episode/sense/sensor_noise_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/base/random.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

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

class Sensing {
 public:
  /// Entities are the scene's bodies, then its hands (as in MakeEntityTable). The settings'
  /// `sensing_hz` must not exceed the scene's rate. A contact point decides about support only if
  /// it carries at least `bearing_share` of the pair's load; otherwise an idle corner point with a
  /// skewed normal would decide.
  Sensing(const physics::Scene& scene, const scenario::SensingSettings& settings);

  /// Whether the snapshot of this tick is sensed: at each tick that completes another 1/sensing_hz.
  /// Computed on integers, so that any rate works without drift.
  /// A frame that the sensors lose is not due.
  bool Due(std::int64_t tick) const {
    return tick * sensing_hz_ / rate_hz_ > (tick - 1) * sensing_hz_ / rate_hz_ &&
           !(noise_ && noise_->Loses(tick));
  }

  /// The changes since the snapshot that was sensed before; the first time, everything. Valid until
  /// the next call. Allocates nothing once the number of contacts no longer grows, as long as no
  /// body falls asleep or wakes.
  grammar::FrameChanges SenseChanges(const physics::Snapshot& snapshot);
  /// Everything, as sensed last. Valid until the next call.
  grammar::Frame Whole();
  grammar::Frame Sense(const physics::Snapshot& snapshot) {
    SenseChanges(snapshot);
    return Whole();
  }

 private:
  using Points = std::span<const physics::ContactPoint>;
  using Touches = std::vector<grammar::Touch>;

  void SenseBodies(const physics::Snapshot& snapshot);
  void Show(int entity, const grammar::EntitySample& look);
  void SenseHands(const physics::Snapshot& snapshot);
  void SenseTouches(const physics::Snapshot& snapshot);
  void ReadTouches(Points points, Touches& touches);
  void CompareTouches(const Touches& before, const Touches& now);
  grammar::Frame WithoutNoise();
  int EntityOf(const physics::ContactSide& side) const;
  std::uint32_t SensorSetOf(const physics::ContactSide& side) const;

  struct HandGeometry {
    physics::HandModel model;
    std::vector<grammar::CollisionSphere> palm;  ///< in the hand's frame
    std::vector<grammar::CollisionSphere>
        links;                ///< in the links' frames, the same number for each link
    std::vector<int> styles;  ///< for each style of the hand, its index in StyleNames
  };

  /// One contact point seen from the pair (a, b) with a < b.
  struct PairPoint {
    std::pair<int, int> pair;
    Eigen::Vector3d nhat_W = Eigen::Vector3d::Zero();  ///< on a
    double impulse_n_s = 0;
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
    std::uint32_t sensor_sets = 0;
  };

  /// The centre of the vertical load of two bodies, the normal there, and how fast their material
  /// moves up or down against each other. Nothing of it is known if they touch side by side.
  void LookAtBearing(std::span<const PairPoint> points, grammar::Touch& touch) const;

  std::int64_t rate_hz_ = 480;
  std::int64_t sensing_hz_ = 240;
  double bearing_share_ = 0;
  std::optional<SensorNoise> noise_;  ///< none: perfect sensors
  int body_count_ = 0;
  std::vector<int> heads_;    ///< for each person, the body that is its head
  std::vector<int> jointed_;  ///< for each joint, the body that it moves
  std::vector<HandGeometry> geometry_;
  std::vector<grammar::EntitySample> entities_;
  std::vector<grammar::HandSample> hands_;
  std::vector<std::vector<grammar::CollisionSphere>> collision_spheres_;  ///< per hand, world frame
  std::vector<PairPoint> points_;
  /// Touches, sorted: of bodies that may move and of bodies that rest.
  struct SensedTouches {
    Touches moving, resting;
    Touches All() const;
  };
  SensedTouches now_, before_;
  std::shared_ptr<const std::vector<physics::ContactPoint>> resting_points_;
  Touches touches_;         ///< all of them, for Whole()
  std::int64_t tick_ = -1;  ///< of the last snapshot

  std::vector<int> shown_;  ///< entities that changed
  std::vector<grammar::EntityChange> entity_changes_;
  Touches touch_changes_;
  std::vector<grammar::ContactEnd> contact_ends_;
};

}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// The state of the world after one tick, as a value. Who: bodies and hands by their index in the
// Scene.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "physics/scene/pose.h"

namespace prehend::physics {

/// Of grains: the mean.
struct BodyState {
  Pose X_WB;
  Eigen::Vector3d v_WB_m_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_rad_per_s = Eigen::Vector3d::Zero();
  bool asleep = false;
};

/// Where a joint stands, in the order of Scene::joints. A fixed or ball joint is always at 0.
struct JointState {
  double position = 0;  ///< metres or radians from where it was placed
  double fraction = 0;  ///< of its range: 0 at the lower limit, 1 at the upper one
};

struct HandState {
  BodyState palm;  ///< never asleep
  std::vector<Pose>
      X_WL;  ///< box centre of every link, local x along it; order of HandModel::links
  std::vector<double> joints;  ///< radians, or metres of links that slide
  Pose X_WTarget;              ///< where the tracked target is
  double trigger = 0;
  int style = 0;  ///< index into HandModel::styles
};

/// One side of a contact: a body (hand == -1) or a link of a hand (link == -1 is the palm).
struct ContactSide {
  int body = -1;
  int hand = -1;
  int link = -1;
  friend auto operator<=>(const ContactSide&, const ContactSide&) = default;
};

/// A point where surfaces touch in the sense of docs/physics.md: pushed in this tick or just
/// before.
struct ContactPoint {
  ContactSide a, b;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d nhat_BA_W = Eigen::Vector3d::UnitZ();  ///< from b into a
  double distance_m = 0;  ///< before the tick (Bullet) or after it (Box2D); negative: penetration
  double normal_impulse_n_s = 0;  ///< over this tick
};

/// Where a person looks, in the order of Scene::persons.
struct GazeState {
  Eigen::Vector3d p_WE_m = Eigen::Vector3d::Zero();     ///< between the eyes
  Eigen::Vector3d toward_W = Eigen::Vector3d::UnitX();  ///< unit
  int body = -1;                                        ///< what she sees there; -1: no body
  int hand = -1;                                        ///< or no hand
  double distance_m = 0;                                ///< to what she sees
};

struct Snapshot {
  std::int64_t tick = 0;  ///< physics steps done; 0 is the scene as placed
  std::vector<BodyState> bodies;
  std::vector<Eigen::Vector3d>
      grains;  ///< centres in the world, of one body with grains after the other
  std::vector<JointState> joints;
  std::vector<HandState> hands;
  std::vector<GazeState> gazes;
  std::vector<ContactPoint> contacts;  ///< of pairs that may move; sorted by (a, b, point); a < b
  /// The points between what rests (fixed or asleep), sorted likewise: they stay as they are, so
  /// snapshots share them until somebody falls asleep or wakes. Null: there are none.
  std::shared_ptr<const std::vector<ContactPoint>> resting;
  /// By body, the last tick at which it may have moved. Empty: nobody knows.
  std::vector<std::int64_t> moved_tick;

  /// False only if the body is for certain as it was after the tick `since`.
  bool MayHaveMoved(std::size_t body, std::int64_t since) const {
    return body >= moved_tick.size() || moved_tick[body] > since;
  }
  /// Where anything touches, in two parts.
  std::array<std::span<const ContactPoint>, 2> AllContacts() const {
    return {contacts, resting ? std::span(*resting) : std::span<const ContactPoint>()};
  }
};

struct Scene;
/// Where the grains of a body of the scene are; where they were placed, if the snapshot has none.
std::span<const Eigen::Vector3d> GrainsOf(const Scene& scene, std::size_t body,
                                          const Snapshot& snapshot);

}  // namespace prehend::physics

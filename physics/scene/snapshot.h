// SPDX-License-Identifier: Apache-2.0
// The state of the world after one tick, as a value. Bodies and hands are named by their index in
// the Scene. Tested by tests/physics/simulation_test.cc
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "physics/base/ids.h"
#include "physics/base/pose.h"

namespace prehend::physics {

/// State of a body; for grains the mean.
struct BodyState {
  Pose X_WB;
  Eigen::Vector3d v_WB_m_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB_rad_per_s = Eigen::Vector3d::Zero();
  bool asleep = false;
};

/// Position of a joint, in the order of Scene::joints. A fixed or ball joint is always at 0.
struct JointState {
  double position = 0;  ///< metres or radians from the initial position
  double fraction = 0;  ///< of its range: 0 at the lower limit, 1 at the upper limit
};

struct HandState {
  BodyState palm;  ///< never asleep
  std::vector<Pose>
      X_WL;  ///< box centre of every link, local x along it; order of HandModel::links
  std::vector<double> joints;  ///< radians, or metres of links that slide
  Pose X_WTarget;              ///< pose of the tracked target
  double trigger = 0;
  int style = 0;  ///< index into HandModel::styles
};

/// One side of a contact: a body, or a link of a hand; the palm if there is no link.
struct ContactSide {
  BodyIndex body = {};
  HandIndex hand = {};
  LinkIndex link = {};
  friend auto operator<=>(const ContactSide&, const ContactSide&) = default;
};

/// A contact point in the sense of docs/physics.md: with an impulse in this tick or shortly before.
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
  BodyIndex body = {};                                  ///< that she sees, or none
  HandIndex hand = {};                                  ///< likewise
  double distance_m = 0;                                ///< to the surface that she sees
};

struct Snapshot {
  std::int64_t tick = 0;  ///< physics steps done; 0 is the scene as placed
  std::vector<BodyState> bodies;
  std::vector<Eigen::Vector3d> grains;  ///< centres in the world, body by body
  std::vector<JointState> joints;
  std::vector<HandState> hands;
  std::vector<GazeState> gazes;
  std::vector<ContactPoint> contacts;  ///< of pairs that may move, sorted by (a, b, point); a < b
  /// Contact points between bodies that rest (fixed or asleep), sorted likewise. They do not
  /// change, so snapshots share them until a body falls asleep or wakes. Null: there are none.
  std::shared_ptr<const std::vector<ContactPoint>> resting;
  /// By body, the last tick at which it may have moved. Empty: unknown.
  std::vector<std::int64_t> moved_tick;

  const BodyState& body(BodyIndex index) const { return At(bodies, index); }
  const HandState& hand(HandIndex index) const { return At(hands, index); }

  /// False only if the state of the body is certainly the same as after the tick `since`.
  bool MayHaveMoved(std::size_t body, std::int64_t since) const {
    return body >= moved_tick.size() || moved_tick[body] > since;
  }
  /// All contact points, in two parts.
  std::array<std::span<const ContactPoint>, 2> AllContacts() const {
    return {contacts, resting ? std::span(*resting) : std::span<const ContactPoint>()};
  }
};

struct Scene;
/// Centres of the grains of a body; their initial positions if the snapshot has none.
std::span<const Eigen::Vector3d> GrainsOf(const Scene& scene, BodyIndex body,
                                          const Snapshot& snapshot);

// FNV-1a over 64-bit words, with a shift so that high bits influence low ones: a hash of the bits
// of poses, velocities and joints. Equal hashes mean equal motion. A sleeping body is skipped: it
// was hashed when it last moved. Tested by tests/physics/simulation_test.cc

class StateHash {
 public:
  void Add(const double* values, Eigen::Index count) {
    for (Eigen::Index i = 0; i < count; ++i) Add(std::bit_cast<std::uint64_t>(values[i]));
  }
  void Add(std::uint64_t word) {
    value_ = (value_ ^ word) * 1099511628211ULL;
    value_ ^= value_ >> 32;
  }
  void Add(const BodyState& state) {
    Add(state.X_WB.p_m.data(), 3);
    Add(state.X_WB.q.coeffs().data(), 4);
    Add(state.v_WB_m_per_s.data(), 3);
    Add(state.w_WB_rad_per_s.data(), 3);
  }
  void Add(const HandState& hand) {
    Add(hand.palm);
    Add(hand.joints.data(), static_cast<Eigen::Index>(hand.joints.size()));
  }
  void Add(const Snapshot& snapshot) {
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
      if (snapshot.bodies[i].asleep) continue;
      Add(std::uint64_t{i});
      Add(snapshot.bodies[i]);
    }
    for (const Eigen::Vector3d& grain : snapshot.grains) Add(grain.data(), 3);
    for (const JointState& joint : snapshot.joints) Add(&joint.position, 1);
    for (const GazeState& gaze : snapshot.gazes) Add(gaze.toward_W.data(), 3);
    for (const HandState& hand : snapshot.hands) Add(hand);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603ULL;
};

}  // namespace prehend::physics

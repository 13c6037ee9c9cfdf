// SPDX-License-Identifier: Apache-2.0
// How an engine moves rigid bodies from tick to tick, in its order of operations: what a recording
// can guess, it need not keep. A wrong guess costs bytes and nothing else. Tested by
// tests/harness/episode/frames/columns_test.cc
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "physics/base/pose.h"
#include "physics/scene/hand_model.h"

namespace prehend::episode {

struct Vector3 {
  double x = 0, y = 0, z = 0;
};

/// A quaternion.
struct Turn {
  double x = 0, y = 0, z = 0, w = 1;
};

Turn ToTurn(const Eigen::Quaterniond& q);
Vector3 ToVector3(const Eigen::Vector3d& v);
Turn Inverse(const Turn& q);
Vector3 Rotated(const Turn& q, const Vector3& v);

/// The rotation after one more `dt_s` at this angular velocity (the exponential map).
Turn Turned(const Turn& before, const Vector3& w_rad_per_s, double dt_s);

/// So many frames are computed at a time, as processors have wide registers.
inline constexpr std::size_t kLanes = 4;
using Lanes = std::array<double, kLanes>;

/// A palm, or a link on it, in several frames.
struct PlacedLinks {
  alignas(32) std::array<Lanes, 4> turn{};  ///< x y z w, from the world to it
  alignas(32) std::array<Lanes, 3> p_m{};   ///< from where the links on it go on
  std::array<physics::Pose, kLanes> X_WL;

  void PutPalm(std::size_t lane, const physics::Pose& X_WPalm);
  /// What is known of its pose after all; the links on it go on from there.
  void Correct(std::size_t lane, const physics::Pose& found);
};

/// Where the links of a hand are that has these joints: forward kinematics, link after link.
class LinkGuess {
 public:
  explicit LinkGuess(const physics::HandModel& model);
  std::size_t size() const { return links_.size(); }
  /// The link that this one is on; -1: the palm.
  int ParentOf(std::size_t link) const { return links_[link].parent; }
  void Guess(std::size_t link, const PlacedLinks& parent, const Lanes& joints,
             PlacedLinks& placed) const;

 private:
  struct Link {
    int parent = -1;
    bool slides = false;
    Turn turn;     ///< from the parent's frame to this one, the joint at zero
    Vector3 axis;  ///< of the joint, in this frame
    double axis_length = 1;
    Vector3 pivot, centre;
  };
  std::vector<Link> links_;
};

}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// How an engine moves rigid bodies from tick to tick, in its order of operations: what a recording
// can guess, it need not keep. A wrong guess costs bytes and nothing else. Tested by
// tests/harness/frames/columns_test.cc
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "physics/scene/hand_model.h"
#include "physics/scene/pose.h"

namespace prehend::harness::episodes {

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

/// Where the links of a hand are that has these joints: forward kinematics, link after link.
class LinkGuess {
 public:
  explicit LinkGuess(const physics::HandModel& model);
  std::size_t size() const { return links_.size(); }
  /// What is known of a link's pose after all, once it is guessed; the links on it follow that.
  using Correction = std::function<void(std::size_t link, physics::Pose& X_WL)>;
  /// `joints`: one per link. `X_WL`: as many poses.
  void Guess(const physics::Pose& X_WPalm, const std::vector<double>& joints,
             std::span<physics::Pose> X_WL, const Correction& correct = {});

 private:
  struct Link {
    int parent = -1;
    bool slides = false;
    Turn turn;     ///< from the parent's frame to this one, the joint at zero
    Vector3 axis;  ///< of the joint, in this frame
    Vector3 pivot, centre;
  };
  std::vector<Link> links_;
  std::vector<Turn> turns_;  ///< from the world to the link
};

}  // namespace prehend::harness::episodes

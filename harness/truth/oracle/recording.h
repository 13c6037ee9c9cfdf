// SPDX-License-Identifier: Apache-2.0
// The recording as the oracle reads it: frames by index, time in ticks. Entities are the scene's
// bodies, then its hands. Tested by tests/harness/truth/oracle/oracle_test.cc
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/truth/oracle/spans.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::truth {

struct Recording {
  const physics::Scene& scene;
  std::span<const physics::Snapshot> frames;
  std::vector<grammar::Tick> ticks;  ///< one per frame

  int size() const { return static_cast<int>(frames.size()); }
  int body_count() const { return static_cast<int>(scene.bodies.size()); }
  double Ticks(double seconds) const { return seconds * scene.world.rate_hz; }
  double Seconds(int from_frame, int to_frame) const;
  double Lasts_s(Span span) const;

  const physics::BodyState& body(int body, int frame) const { return frames[frame].bodies[body]; }
  const physics::HandState& hand(int hand, int frame) const { return frames[frame].hands[hand]; }
  const Eigen::Vector3d& place(int body, int frame) const {
    return frames[frame].bodies[body].X_WB.p_m;
  }
  const std::string& name(int entity) const;
};

Recording MakeRecording(const physics::Scene& scene, std::span<const physics::Snapshot> frames);

/// Velocity of the body's material at a point.
Eigen::Vector3d VelocityAt(const physics::BodyState& body, const Eigen::Vector3d& p_W_m);

/// Two entities in the order in which the fact names them.
using Pair = std::pair<int, int>;

}  // namespace prehend::truth

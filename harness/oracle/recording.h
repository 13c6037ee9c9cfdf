// SPDX-License-Identifier: Apache-2.0
// The recording as the oracle reads it: frames by index, time in ticks, and who touched whom in
// every frame. Entities are the scene's bodies, then its hands. Tested by
// tests/harness/oracle/oracle_test.cc
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/oracle/settings.h"
#include "harness/oracle/spans.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::harness::oracle {

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

/// Velocity of the object's origin relative to the material of `support` that is there at the
/// moment.
Eigen::Vector3d RelativeVelocity(const physics::BodyState& object,
                                 const physics::BodyState& support);

/// Two entities in the order in which the fact names them.
using Pair = std::pair<int, int>;

struct Grasp {
  int hand = 0;  ///< index into Scene::hands
  int body = 0;
  Span span;
  int touched_since = 0;  ///< the hand touches it, and has not grasped it in between
};

/// Everything that follows from contacts alone; gaps are bridged as the definitions allow.
struct Touches {
  std::map<Pair, Spans> contacts;  ///< entities a < b
  std::map<Pair, Spans> supports;  ///< (object, support), both bodies, the object movable
  std::vector<Grasp> grasps;       ///< sorted by hand, body, time
};
Touches FindTouches(const Recording& recording, const OracleSettings& settings);

}  // namespace prehend::harness::oracle

// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/oracle/recording.h"

namespace prehend::truth {

double Recording::Seconds(int from_frame, int to_frame) const {
  return static_cast<double>(ticks[to_frame] - ticks[from_frame]) / scene.world.rate_hz;
}

double Recording::Lasts_s(Span span) const {
  const grammar::Tick end = span.end < size() ? ticks[span.end] : ticks.back() + 1;
  return static_cast<double>(end - ticks[span.begin]) / scene.world.rate_hz;
}

const std::string& Recording::name(int entity) const {
  return entity < body_count() ? scene.bodies[entity].name
                               : scene.hands[entity - body_count()].name;
}

Recording MakeRecording(const physics::Scene& scene, std::span<const physics::Snapshot> frames) {
  Recording recording{scene, frames, {}};
  for (const physics::Snapshot& frame : frames) recording.ticks.push_back(frame.tick);
  return recording;
}

Eigen::Vector3d VelocityAt(const physics::BodyState& body, const Eigen::Vector3d& p_W_m) {
  return body.v_WB_m_per_s + body.w_WB_rad_per_s.cross(p_W_m - body.X_WB.p_m);
}

}  // namespace prehend::truth

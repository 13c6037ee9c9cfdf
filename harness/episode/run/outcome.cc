// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/outcome.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/scene/geometry.h"

namespace prehend::episode {
namespace {

double TiltDeg(const physics::Pose& placed, const physics::Pose& now) {
  const Eigen::Vector3d up = now.q * (placed.q.conjugate() * Eigen::Vector3d::UnitZ());
  return std::acos(std::clamp(up.z(), -1.0, 1.0)) * 180 / std::numbers::pi;
}

bool Within(const std::vector<double>& wanted, double within_m, const Eigen::Vector3d& p) {
  const auto size = static_cast<Eigen::Index>(wanted.size());
  return (Eigen::Map<const Eigen::VectorXd>(wanted.data(), size) - p.head(size)).norm() <= within_m;
}

}  // namespace

OutcomeWatch::OutcomeWatch(const physics::Scene& scene,
                           const std::vector<scenario::Outcome>& outcomes)
    : scene_(scene), outcomes_(outcomes) {
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    for (std::size_t k = 0; k < outcomes[i].conditions.size(); ++k) {
      const auto& at_s = outcomes[i].conditions[k].wanted.at_s;
      if (at_s) timed_.push_back({std::llround(*at_s * scene.world.rate_hz), i, k, false});
    }
  }
}

void OutcomeWatch::Look(const physics::Snapshot& snapshot) {
  for (TimedCondition& timed : timed_) {
    if (timed.tick == snapshot.tick)
      timed.holds = Holds(outcomes_[timed.outcome].conditions[timed.condition], snapshot);
  }
}

std::string OutcomeWatch::Judge(const physics::Snapshot& last) const {
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    bool holds = true;
    for (const auto& condition : outcomes_[i].conditions)
      holds &= condition.wanted.at_s || Holds(condition, last);
    for (const TimedCondition& timed : timed_) holds &= timed.outcome != i || timed.holds;
    if (holds) return outcomes_[i].name;
  }
  return kOtherOutcome;
}

bool OutcomeWatch::Holds(const scenario::Outcome::Condition& condition,
                         const physics::Snapshot& snapshot) const {
  const scenario::ConditionYaml& wanted = condition.wanted;
  const physics::Body& body = scene_.body(condition.body);
  const physics::BodyState& state = snapshot.body(condition.body);
  const Eigen::Vector3d centre = state.X_WB * physics::BoundingBox(body).p_BC_m;
  const double tilt_deg = TiltDeg(body.X_WB, state.X_WB);
  const double fraction =
      condition.joint < 0 ? 0 : snapshot.joints[static_cast<std::size_t>(condition.joint)].fraction;
  return (!wanted.near_m || Within(*wanted.near_m, wanted.within_m, centre)) &&
         (!wanted.above_m || centre.z() > *wanted.above_m) &&
         (!wanted.below_m || centre.z() < *wanted.below_m) &&
         (!wanted.tilt_below_deg || tilt_deg < *wanted.tilt_below_deg) &&
         (!wanted.tilt_above_deg || tilt_deg > *wanted.tilt_above_deg) &&
         (!wanted.slower_than_m_per_s || state.v_WB_m_per_s.norm() < *wanted.slower_than_m_per_s) &&
         (!wanted.joint_above || fraction > *wanted.joint_above) &&
         (!wanted.joint_below || fraction < *wanted.joint_below) &&
         (!wanted.inside || ShareInside(condition, snapshot) >= wanted.share);
}

/// The share of the body's grains that are inside the vessel; 0 or 1 for a body without grains.
double OutcomeWatch::ShareInside(const scenario::Outcome::Condition& condition,
                                 const physics::Snapshot& snapshot) const {
  const physics::Body &vessel = scene_.body(condition.vessel), &body = scene_.body(condition.body);
  const physics::Pose& X_WV = snapshot.body(condition.vessel).X_WB;
  if (!body.grains) {
    const Eigen::Vector3d p_W_m =
        snapshot.body(condition.body).X_WB * physics::BoundingBox(body).p_BC_m;
    return physics::IsInside(vessel, X_WV, p_W_m) ? 1 : 0;
  }
  const std::span<const Eigen::Vector3d> grains =
      physics::GrainsOf(scene_, condition.body, snapshot);
  const auto inside = std::count_if(
      grains.begin(), grains.end(),
      [&](const Eigen::Vector3d& p_W_m) { return physics::IsInside(vessel, X_WV, p_W_m); });
  return static_cast<double>(inside) / static_cast<double>(grains.size());
}

}  // namespace prehend::episode

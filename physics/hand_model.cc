// SPDX-License-Identifier: Apache-2.0
// What follows from a hand model alone: joint targets, forward kinematics, the mirror image, stable
// gains. Tested by tests/physics/hand_model_test.cc
#include "physics/hand_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstdio>

namespace prehend::physics {
namespace {

Eigen::Matrix3d BoxInertia(double mass_kg, const Eigen::Vector3d& size_m) {
  const Eigen::Vector3d s2 = size_m.cwiseAbs2();
  return (mass_kg / 12) *
         Eigen::Vector3d(s2.y() + s2.z(), s2.x() + s2.z(), s2.x() + s2.y()).asDiagonal();
}

/// About H's origin, all joints at zero.
Eigen::Matrix3d WholeInertia(const HandModel& model) {
  Eigen::Matrix3d inertia =
      model.palm_inertia_scale * BoxInertia(model.palm_mass_kg, model.palm_size_m);
  const auto poses = LinkPoses(model, std::vector<double>(model.links.size(), 0.0));
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const HandLink& link = model.links[i];
    const Eigen::Vector3d size(link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m);
    const Eigen::Matrix3d R = poses[i].q.toRotationMatrix();
    const Eigen::Vector3d& p = poses[i].p_m;
    inertia += R * BoxInertia(link.mass_kg, size) * R.transpose() +
               link.mass_kg * (p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose());
  }
  return inertia;
}

std::string TooStiff(const char* which, double derivative, double inertia, const char* unit,
                     int rate_hz) {
  const double ratio = derivative / (rate_hz * inertia);
  if (ratio < 1) return "";
  char text[256];
  std::snprintf(text, sizeof text,
                "the %s derivative gain %g cannot be stable: gain * dt / inertia = %g * (1/%d s) / "
                "%.4g %s = %.2f, "
                "which must stay below 1 (at most %.4g here)",
                which, derivative, derivative, rate_hz, inertia, unit, ratio,
                0.99 * rate_hz * inertia);
  return text;
}

void MirrorVector(Eigen::Vector3d& v) { v.y() = -v.y(); }

}  // namespace

std::vector<double> JointTargets(const GraspStyle& style, double trigger) {
  const double last = static_cast<double>(style.frames_rad.size() - 1);
  const double x = std::clamp(trigger, 0.0, 1.0) * last;
  const auto frame = static_cast<std::size_t>(std::min(x, last - 1));
  const double share = x - static_cast<double>(frame);
  std::vector<double> targets = style.frames_rad[frame];
  for (std::size_t i = 0; i < targets.size(); ++i)
    targets[i] += share * (style.frames_rad[frame + 1][i] - targets[i]);
  return targets;
}

std::vector<Pose> LinkPoses(const HandModel& model, const std::vector<double>& joints_rad) {
  std::vector<Pose> moved(model.links.size());  // what the joints up to this link do to points of H
  std::vector<Pose> centres(model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const HandLink& link = model.links[i];
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(joints_rad[i], link.joint_axis));
    const Pose joint{link.pivot_m - turn * link.pivot_m, turn};
    moved[i] = link.parent < 0 ? joint : moved[static_cast<std::size_t>(link.parent)] * joint;
    const Pose rest{link.pivot_m + link.direction * (link.length_m / 2),
                    Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), link.direction)};
    centres[i] = moved[i] * rest;
  }
  return centres;
}

HandModel Mirrored(HandModel model) {
  model.left = !model.left;
  MirrorVector(model.ahead);
  for (HandLink& link : model.links) {
    MirrorVector(link.pivot_m);
    MirrorVector(link.direction);
    // An axis of rotation is a pseudo-vector: its components in the mirror's plane flip, the normal
    // one stays.
    link.joint_axis = {-link.joint_axis.x(), link.joint_axis.y(), -link.joint_axis.z()};
  }
  for (GraspStyle& style : model.styles) {
    MirrorVector(style.grip_axis);
    MirrorVector(style.post_m);
    for (auto* approach : {&style.above, &style.side}) {
      if (!*approach) continue;
      MirrorVector((*approach)->toward);
      MirrorVector((*approach)->up);
    }
  }
  return model;
}

int FindStyle(const HandModel& model, const std::string& name) {
  const auto it = std::find_if(model.styles.begin(), model.styles.end(),
                               [&](const GraspStyle& style) { return style.name == name; });
  return it == model.styles.end() ? -1 : static_cast<int>(it - model.styles.begin());
}

std::string CheckGains(const HandModel& model, int rate_hz) {
  double mass_kg = model.palm_mass_kg;
  for (const HandLink& link : model.links) mass_kg += link.mass_kg;
  const std::string problem =
      TooStiff("translation", model.translation.derivative, mass_kg, "kg", rate_hz);
  if (!problem.empty()) return problem;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(WholeInertia(model),
                                                              Eigen::EigenvaluesOnly);
  return TooStiff("rotation", model.rotation.derivative, solver.eigenvalues()[0], "kg m^2",
                  rate_hz);
}

}  // namespace prehend::physics

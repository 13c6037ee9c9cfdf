// SPDX-License-Identifier: Apache-2.0
// Joint targets, forward kinematics, the mirror image and stable gains, from a hand model alone.
// Tested by tests/physics/scene/hand_model_test.cc
#include "physics/scene/hand_model.h"

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

/// Moments of inertia about H's origin, all joints at zero.
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

/// The smallest and the largest mass or moment of inertia that a PID moves.
struct Inertia {
  const char* of;
  const char* unit;
  double least;
  double most;
};

std::string NotPositive(const Inertia& inertia, const PidGains& gains) {
  char text[160];
  for (const auto& [name, gain] :
       {std::pair{"proportional gain", gains.proportional},
        std::pair{"derivative gain", gains.derivative}, std::pair{"limit", gains.limit}}) {
    if (gain > 0) continue;
    std::snprintf(text, sizeof text,
                  "the %s %s is %g; without it the hand cannot follow its target", inertia.of, name,
                  gain);
    return text;
  }
  return "";
}

/// A mass m under F = -kp x - kd v, stepped by semi-implicit Euler, is stable if kp dt^2/m + 2 kd
/// dt/m < 4 (Jury). With an integral term in continuous time: ki m < kp kd (Routh and Hurwitz).
std::string Diverges(const Inertia& inertia, const PidGains& gains, int rate_hz) {
  char text[256];
  const double dt_s = 1.0 / rate_hz;
  const double room = 4 - 2 * gains.derivative * dt_s / inertia.least;
  const double most_proportional = room * inertia.least / (dt_s * dt_s);
  if (gains.proportional >= most_proportional) {
    std::snprintf(text, sizeof text,
                  "the %s proportional gain %g cannot be stable: it overshoots more with every "
                  "1/%d s; it must stay below "
                  "%.4g here",
                  inertia.of, gains.proportional, rate_hz, most_proportional);
    return text;
  }
  const double most_integral = gains.proportional * gains.derivative / inertia.most;
  if (gains.integral >= most_integral) {
    std::snprintf(text, sizeof text,
                  "the %s integral gain %g cannot be stable: it must stay below proportional * "
                  "derivative / inertia = %.4g",
                  inertia.of, gains.integral, most_integral);
    return text;
  }
  return "";
}

/// Bounds the derivative gain alone: too much damping excites the hand.
std::string TooStiff(const Inertia& inertia, const PidGains& gains, int rate_hz) {
  const double ratio = gains.derivative / (rate_hz * inertia.least);
  if (ratio < 1) return "";
  char text[256];
  std::snprintf(text, sizeof text,
                "the %s derivative gain %g cannot be stable: gain * dt / inertia = %g * (1/%d s) / "
                "%.4g %s = %.2f, "
                "which must stay below 1 (at most %.4g here)",
                inertia.of, gains.derivative, gains.derivative, rate_hz, inertia.least,
                inertia.unit, ratio, 0.99 * rate_hz * inertia.least);
  return text;
}

/// Empty when these gains are stable.
std::string WhyUnstable(const Inertia& inertia, const PidGains& gains, int rate_hz) {
  std::string problem = NotPositive(inertia, gains);
  if (problem.empty()) problem = TooStiff(inertia, gains, rate_hz);
  if (problem.empty()) problem = Diverges(inertia, gains, rate_hz);
  return problem;
}

/// The motion of points of H caused by one joint while its parents are at zero.
Pose JointMotion(const HandLink& link, double value) {
  if (link.slides) return {link.joint_axis * value};
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(value, link.joint_axis));
  return {link.pivot_m - turn * link.pivot_m, turn};
}

void MirrorVector(Eigen::Vector3d& v) { v.y() = -v.y(); }

}  // namespace

double WantedSpeed(const JointDriver& driver, const HandLink& link, double target, double joint,
                   double dt_s) {
  const double limit = link.slides ? driver.max_slide_m_per_s : driver.max_speed_rad_per_s;
  return std::clamp(driver.stiffness * (target - joint) / dt_s, -limit, limit);
}

std::vector<double> JointTargets(const GraspStyle& style, double trigger) {
  const double last = static_cast<double>(style.frames.size() - 1);
  const double x = std::clamp(trigger, 0.0, 1.0) * last;
  const auto frame = static_cast<std::size_t>(std::min(x, last - 1));
  const double share = x - static_cast<double>(frame);
  std::vector<double> targets = style.frames[frame];
  for (std::size_t i = 0; i < targets.size(); ++i)
    targets[i] += share * (style.frames[frame + 1][i] - targets[i]);
  return targets;
}

std::vector<Pose> LinkPoses(const HandModel& model, const std::vector<double>& joints) {
  std::vector<Pose> moved(
      model.links.size());  // motion of points of H by all joints up to this link
  std::vector<Pose> centres(model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const HandLink& link = model.links[i];
    const Pose joint = JointMotion(link, joints[i]);
    moved[i] = link.parent == kNone ? joint : At(moved, link.parent) * joint;
    const Pose rest{link.pivot_m + link.direction * (link.length_m / 2),
                    RotationBetween(Eigen::Vector3d::UnitX(), link.direction)};
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
    MirrorVector(link.joint_axis);
    // An axis of rotation is a pseudo-vector: its components in the mirror plane change sign, the
    // normal one does not.
    if (!link.slides) link.joint_axis = -link.joint_axis;
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
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(WholeInertia(model),
                                                              Eigen::EigenvaluesOnly);
  const Inertia translation{"translation", "kg", mass_kg, mass_kg};
  const Inertia rotation{"rotation", "kg m^2", solver.eigenvalues()[0], solver.eigenvalues()[2]};
  std::string problem = WhyUnstable(translation, model.translation, rate_hz);
  if (problem.empty()) problem = WhyUnstable(rotation, model.rotation, rate_hz);
  return problem;
}

}  // namespace prehend::physics

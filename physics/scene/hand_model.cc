// SPDX-License-Identifier: Apache-2.0
// Joint targets, forward kinematics, the mirror image and stable gains, from a hand model alone.
#include "physics/scene/hand_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace prehend::physics {

namespace {

Eigen::Quaterniond Product(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return {a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z(),
          a.w() * b.x() + a.x() * b.w() + a.y() * b.z() - a.z() * b.y(),
          a.w() * b.y() + a.y() * b.w() + a.z() * b.x() - a.x() * b.z(),
          a.w() * b.z() + a.z() * b.w() + a.x() * b.y() - a.y() * b.x()};
}

/// p + q v q*.
Eigen::Vector3d Moved(const Eigen::Vector3d& p, const Eigen::Quaterniond& q,
                      const Eigen::Vector3d& v) {
  const double x = 2 * (q.y() * v.z() - q.z() * v.y()), y = 2 * (q.z() * v.x() - q.x() * v.z()),
               z = 2 * (q.x() * v.y() - q.y() * v.x());
  return {p.x() + (v.x() + q.w() * x + (q.y() * z - q.z() * y)),
          p.y() + (v.y() + q.w() * y + (q.z() * x - q.x() * z)),
          p.z() + (v.z() + q.w() * z + (q.x() * y - q.y() * x))};
}

struct SineAndCosine {
  double sine = 0, cosine = 1;
};

/// As fdlibm's: what is left of the nearest quarter turn, then a polynomial.
SineAndCosine Of(double angle) {
  if (!(std::abs(angle) < 1e6)) return {};  // no joint is there
  const double quarters = std::floor(angle * (2 / std::numbers::pi) + 0.5);
  const double x =
      (angle - quarters * 1.57079632673412561417e+00) - quarters * 6.07710050650619224932e-11;
  const double z = x * x;
  const double s =
      x + x * z *
              (-1.66666666666666324348e-01 +
               z * (8.33333333332248946124e-03 +
                    z * (-1.98412698298579493134e-04 +
                         z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 +
                                                                z * 1.58969099521155010221e-10)))));
  const double c =
      1 -
      (0.5 * z -
       z * z *
           (4.16666666666666019037e-02 +
            z * (-1.38888888888741095749e-03 +
                 z * (2.48015872894767294178e-05 +
                      z * (-2.75573143513906633035e-07 +
                           z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11))))));
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

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
                  "1/%d s; it must stay below %.4g here",
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
                "%.4g %s = %.2f, which must stay below 1 (at most %.4g here)",
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

LinkPlaces::LinkPlaces(const HandModel& model) {
  const auto reversed = [](const Eigen::Quaterniond& q) {
    return Eigen::Quaterniond(q.w(), -q.x(), -q.y(), -q.z());
  };
  const Eigen::Vector3d origin(0, 0, 0);
  std::vector<Pose> X_HL;
  for (const HandLink& link : model.links) {
    const Pose X_HP = link.parent == kNone ? Pose() : At(X_HL, link.parent);
    const Eigen::Vector3d& d = link.direction;
    const double half_m = link.length_m / 2;
    Pose& X = X_HL.emplace_back();
    X = {{link.pivot_m.x() + d.x() * half_m, link.pivot_m.y() + d.y() * half_m,
          link.pivot_m.z() + d.z() * half_m},
         RotationBetween(Eigen::Vector3d::UnitX(), d)};
    const Eigen::Vector3d p_PJ_m = link.pivot_m - X_HP.p_m, p_JL_m = X.p_m - link.pivot_m;
    links_.push_back({.parent = link.parent,
                      .slides = link.slides,
                      .q_PL = Product(reversed(X_HP.q), X.q),
                      .axis = Moved(origin, reversed(X.q), link.joint_axis),
                      .p_PJ_m = Moved(origin, reversed(X_HP.q), p_PJ_m),
                      .p_JL_m = Moved(origin, reversed(X.q), p_JL_m)});
  }
}

void LinkPlaces::Place(const Pose& X_WPalm, const std::vector<double>& joints,
                       std::vector<Pose>& X_WL) const {
  X_WL.resize(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const Pose& X_WP = link.parent == kNone ? X_WPalm : At(X_WL, link.parent);
    const Eigen::Vector3d &a = link.axis, &p = link.p_JL_m;
    const double way = joints[i];
    const Eigen::Vector3d p_WJ_m = Moved(X_WP.p_m, X_WP.q, link.p_PJ_m);
    const Eigen::Quaterniond q_WL = Product(X_WP.q, link.q_PL);
    if (link.slides) {
      X_WL[i] = {
          Moved(p_WJ_m, q_WL, {p.x() + way * a.x(), p.y() + way * a.y(), p.z() + way * a.z()}),
          q_WL};
      continue;
    }
    const auto [sine, cosine] = Of(0.5 * way);
    const Eigen::Quaterniond q_WT =
        Product(q_WL, {cosine, a.x() * sine, a.y() * sine, a.z() * sine});
    X_WL[i] = {Moved(p_WJ_m, q_WT, p), q_WT};
  }
}

double WantedSpeed(const JointDriver& driver, const HandLink& link, double target, double joint,
                   double dt_s) {
  const double limit = link.slides ? driver.max_slide_m_per_s : driver.max_speed_rad_per_s;
  const double ticks = dt_s * JointDriver::kStiffnessRate_hz;
  const double share = std::min(driver.stiffness * ticks * std::max(ticks, 1.0), 1.0);
  return std::clamp(share * (target - joint) / dt_s, -limit, limit);
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

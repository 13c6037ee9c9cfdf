// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/link_places.h"

#include <cmath>
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

}  // namespace prehend::physics

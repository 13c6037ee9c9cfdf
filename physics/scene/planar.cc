// SPDX-License-Identifier: Apache-2.0
// One visitor per question over the kinds of shapes.
#include "physics/scene/planar.h"

#include <cmath>

namespace prehend::physics {
namespace {

/// Tolerance, metres or sine of an angle: above the rounding errors of positions and of rotations
/// by whole degrees.
constexpr double kTolerance = 1e-6;

bool InPlane(const Eigen::Vector3d& v) { return std::abs(v.y()) < kTolerance; }
bool Across(const Eigen::Vector3d& unit) { return std::hypot(unit.x(), unit.z()) < kTolerance; }
bool InOrAcross(const Eigen::Vector3d& unit) { return InPlane(unit) || Across(unit); }

Eigen::Vector2d Flat(const Eigen::Vector3d& v) { return {v.x(), v.z()}; }

double AngleOf(const Eigen::Vector3d& axis) { return std::atan2(axis.z(), axis.x()); }

/// Whether the shape's axes are in the plane or across it.
struct AxesFit {
  const Eigen::Matrix3d R;

  bool operator()(const Box&) const {
    return InOrAcross(R.col(0)) && InOrAcross(R.col(1)) && InOrAcross(R.col(2));
  }
  bool operator()(const Sphere&) const { return true; }
  bool operator()(const Cylinder&) const { return InOrAcross(R.col(2)); }
  bool operator()(const Capsule&) const { return InOrAcross(R.col(2)); }
  bool operator()(const Hull&) const { return false; }  // its cross-section may change along y
};

/// The two axes of a box in the plane.
std::pair<int, int> AxesInPlane(const Eigen::Matrix3d& R) {
  if (Across(R.col(0))) return {1, 2};
  return Across(R.col(1)) ? std::pair{0, 2} : std::pair{0, 1};
}

struct OutlineOfShape {
  const Eigen::Matrix3d R;
  const Eigen::Vector2d centre_m;

  Outline operator()(const Box& s) const {
    const auto [a, b] = AxesInPlane(R);
    return {centre_m, AngleOf(R.col(a)), Eigen::Vector2d(s.size_m[a], s.size_m[b]) / 2, 0};
  }
  Outline operator()(const Sphere& s) const { return Disc(s.radius_m); }
  Outline operator()(const Cylinder& s) const {
    if (Across(R.col(2))) return Disc(s.radius_m);
    return {centre_m, AngleOf(R.col(2)), {s.length_m / 2, s.radius_m}, 0};
  }
  Outline operator()(const Capsule& s) const {
    if (Across(R.col(2))) return Disc(s.radius_m);
    return {centre_m, AngleOf(R.col(2)), {s.length_m / 2, 0}, s.radius_m};
  }
  Outline operator()(const Hull&) const { return {}; }  // none lies in the plane

 private:
  Outline Disc(double radius_m) const { return {centre_m, 0, Eigen::Vector2d::Zero(), radius_m}; }
};

/// Square of the radius of gyration about y, m^2.
struct GyrationAboutY {
  const Eigen::Matrix3d R;

  double operator()(const Box& s) const {
    const auto [a, b] = AxesInPlane(R);
    return (s.size_m[a] * s.size_m[a] + s.size_m[b] * s.size_m[b]) / 12;
  }
  double operator()(const Sphere& s) const { return 2.0 / 5 * s.radius_m * s.radius_m; }
  double operator()(const Cylinder& s) const {
    const double r2 = s.radius_m * s.radius_m;
    return Across(R.col(2)) ? r2 / 2 : r2 / 4 + s.length_m * s.length_m / 12;
  }
  double operator()(const Capsule& s) const {
    const double r = s.radius_m, l = s.length_m;
    const double ball_share = 4 * r / (4 * r + 3 * l);  // of the volume
    const double ball = 2.0 / 5 * r * r;
    const double rod = (*this)(Cylinder{r, l});
    // Each half ball's centre of mass lies 3/8 r beyond the rod's end.
    const double apart = Across(R.col(2)) ? 0 : l * l / 4 + 3.0 / 8 * l * r;
    return ball_share * (ball + apart) + (1 - ball_share) * rod;
  }
  double operator()(const Hull&) const { return 0; }  // none lies in the plane
};

std::string WhyNotPlanar(const GraspStyle& style) {
  const auto off = [](const std::optional<GraspApproach>& approach) {
    return approach && !InPlane(approach->toward);
  };
  if (!InPlane(style.grip_axis) || !InPlane(style.post_m))
    return "its style '" + style.name + "' does not grip in the plane";
  if (off(style.above) || off(style.side) || (style.side && !Across(style.side->up)))
    return "its style '" + style.name + "' does not arrive in the plane";
  return "";
}

}  // namespace

bool KeepsPlane(const Pose& X_WB) {
  return InPlane(X_WB.p_m) && Across(X_WB.q * Eigen::Vector3d::UnitY());
}

bool LiesInPlane(const Shape& shape, const Pose& X_WS) {
  return InPlane(X_WS.p_m) && std::visit(AxesFit{X_WS.q.toRotationMatrix()}, shape);
}

std::string WhyNotPlanar(const Body& body) {
  if (body.grains) return "grains do not stay in the plane";
  if (body.abstract != Abstract::kNot) return "";  // nothing touches it
  if (!InPlane(body.X_WB.p_m)) return "its centre is off the plane y = 0";
  for (const PlacedShape& placed : body.shapes) {
    const Pose X_WS = body.X_WB * placed.X_BS;
    if (!InPlane(X_WS.p_m)) return "a part of it is not in the plane y = 0";
    if (std::holds_alternative<Hull>(placed.shape))
      return "a hull does not have the same cross-section all along y";
    if (!LiesInPlane(placed.shape, X_WS)) return "it is turned out of the plane";
  }
  return "";
}

std::string WhyNotPlanar(const Joint& joint) {
  if (joint.kind == JointKind::kBall) return "a ball joint turns out of the plane";
  if (joint.kind == JointKind::kSlider && !InPlane(joint.axis_W))
    return "its axis leaves the plane y = 0";
  if (joint.kind == JointKind::kHinge && !Across(joint.axis_W))
    return "its axis is not the y axis, so it turns out of the plane";
  return "";
}

std::string WhyNotPlanar(const HandModel& model) {
  const std::vector<Pose> X_HL = LinkPoses(model, std::vector<double>(model.links.size(), 0.0));
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const HandLink& link = model.links[i];
    if (!KeepsPlane(X_HL[i])) return "its link '" + link.name + "' is not in its plane y = 0";
    if (link.slides ? !InPlane(link.joint_axis) : !Across(link.joint_axis))
      return "its link '" + link.name + "' moves out of its plane y = 0";
  }
  for (const GraspStyle& style : model.styles) {
    if (std::string why = WhyNotPlanar(style); !why.empty()) return why;
  }
  return "";
}

Outline OutlineOf(const Shape& shape, const Pose& X_FS) {
  return std::visit(OutlineOfShape{X_FS.q.toRotationMatrix(), Flat(X_FS.p_m)}, shape);
}

double MomentAboutY(const Shape& shape, const Pose& X_FS, double mass_kg) {
  return mass_kg * std::visit(GyrationAboutY{X_FS.q.toRotationMatrix()}, shape);
}

}  // namespace prehend::physics

// SPDX-License-Identifier: Apache-2.0
// See harness/frames/rigid_motion.h. The formulas and their order are those of Bullet
// (btTransformUtil::integrateTransform, btMultiBody::forwardKinematics), so that the last bits
// agree. Tested by tests/harness/frames/columns_test.cc
#include "harness/frames/rigid_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace prehend::harness::episodes {
namespace {

Turn Product(const Turn& a, const Turn& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
      a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

Vector3 Sum(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

/// In the loops of this file a call costs as much as its work.
[[gnu::always_inline]] inline Vector3 Rotate(const Turn& q, const Vector3& v) {
  const Turn half = {q.w * v.x + q.y * v.z - q.z * v.y, q.w * v.y + q.z * v.x - q.x * v.z,
                     q.w * v.z + q.x * v.y - q.y * v.x, -q.x * v.x - q.y * v.y - q.z * v.z};
  const Turn back = {-q.x, -q.y, -q.z, q.w};  // of the product with it, w is 0
  return {half.w * back.x + half.x * back.w + half.y * back.z - half.z * back.y,
          half.w * back.y + half.y * back.w + half.z * back.x - half.x * back.z,
          half.w * back.z + half.z * back.w + half.x * back.y - half.y * back.x};
}

double LengthOf(const Vector3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

Turn AroundAxis(const Vector3& axis, double length, double angle) {
  const double s = std::sin(angle * 0.5) / length;
  return {axis.x * s, axis.y * s, axis.z * s, std::cos(angle * 0.5)};
}

/// The quaternion after its way through a rotation matrix.
Turn ThroughMatrix(const Turn& q) {
  const double s = 2.0 / (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  const double xs = q.x * s, ys = q.y * s, zs = q.z * s;
  const double wx = q.w * xs, wy = q.w * ys, wz = q.w * zs;
  const double xx = q.x * xs, xy = q.x * ys, xz = q.x * zs;
  const double yy = q.y * ys, yz = q.y * zs, zz = q.z * zs;
  const std::array<std::array<double, 3>, 3> m = {{{1.0 - (yy + zz), xy - wz, xz + wy},
                                                   {xy + wz, 1.0 - (xx + zz), yz - wx},
                                                   {xz - wy, yz + wx, 1.0 - (xx + yy)}}};
  const double trace = m[0][0] + m[1][1] + m[2][2];
  if (trace > 0) {
    const double root = std::sqrt(trace + 1.0), scale = 0.5 / root;
    return {(m[2][1] - m[1][2]) * scale, (m[0][2] - m[2][0]) * scale, (m[1][0] - m[0][1]) * scale,
            root * 0.5};
  }
  const std::size_t i =
      m[0][0] < m[1][1] ? (m[1][1] < m[2][2] ? 2 : 1) : (m[0][0] < m[2][2] ? 2 : 0);
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const double root = std::sqrt(m[i][i] - m[j][j] - m[k][k] + 1.0), scale = 0.5 / root;
  std::array<double, 4> values{};
  values[i] = root * 0.5;
  values[3] = (m[k][j] - m[j][k]) * scale;
  values[j] = (m[j][i] + m[i][j]) * scale;
  values[k] = (m[k][i] + m[i][k]) * scale;
  return {values[0], values[1], values[2], values[3]};
}

}  // namespace

Turn ToTurn(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
Vector3 ToVector3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Turn Inverse(const Turn& q) { return {-q.x, -q.y, -q.z, q.w}; }

Vector3 Rotated(const Turn& q, const Vector3& v) { return Rotate(q, v); }

Turn Turned(const Turn& before, const Vector3& w_rad_per_s, double dt_s) {
  const Vector3& w = w_rad_per_s;
  constexpr double kLargestTurn = 0.25 * std::numbers::pi;
  double speed = LengthOf(w);
  if (speed * dt_s > kLargestTurn) speed = kLargestTurn / dt_s;
  const double scale = speed < 0.001
                           ? 0.5 * dt_s - (dt_s * dt_s * dt_s) * 0.020833333333 * speed * speed
                           : std::sin(0.5 * speed * dt_s) / speed;
  const Turn change = {w.x * scale, w.y * scale, w.z * scale, std::cos(speed * dt_s * 0.5)};
  Turn after = Product(change, before);
  const double shrink = 1.0 / std::sqrt(after.x * after.x + after.y * after.y + after.z * after.z +
                                        after.w * after.w);
  after = {after.x * shrink, after.y * shrink, after.z * shrink, after.w * shrink};
  return ThroughMatrix(after);
}

PlacedLink PlacedLink::Palm(const physics::Pose& X_WPalm) {
  return {Inverse(ToTurn(X_WPalm.q)), ToVector3(X_WPalm.p_m), X_WPalm};
}

void PlacedLink::Correct(const physics::Pose& found) {
  X_WL = found;
  p_m = ToVector3(found.p_m);
}

LinkGuess::LinkGuess(const physics::HandModel& model) {
  const std::vector<physics::Pose> rest =
      physics::LinkPoses(model, std::vector<double>(model.links.size(), 0.0));
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const physics::HandLink& link = model.links[i];
    const physics::Pose& X_HL = rest[i];
    const physics::Pose X_HP =
        link.parent < 0 ? physics::Pose{} : rest[static_cast<std::size_t>(link.parent)];
    const Vector3 axis = ToVector3(X_HL.q.conjugate() * link.joint_axis);
    links_.push_back({.parent = link.parent,
                      .slides = link.slides,
                      .turn = ToTurn(X_HL.q.conjugate() * X_HP.q),
                      .axis = axis,
                      .axis_length = LengthOf(axis),
                      .pivot = ToVector3(X_HP.q.conjugate() * (link.pivot_m - X_HP.p_m)),
                      .centre = ToVector3(X_HL.q.conjugate() * (X_HL.p_m - link.pivot_m))});
  }
}

PlacedLink LinkGuess::Guess(std::size_t number, const PlacedLink& parent, double joint) const {
  const Link& link = links_[number];
  const Turn turn =
      link.slides ? link.turn : Product(AroundAxis(link.axis, link.axis_length, -joint), link.turn);
  Vector3 along = Sum(link.centre, Rotate(turn, link.pivot));
  if (link.slides)
    along = Sum(along, {joint * link.axis.x, joint * link.axis.y, joint * link.axis.z});
  PlacedLink placed;
  placed.turn = Product(turn, parent.turn);
  const Turn world = Inverse(placed.turn);
  placed.p_m = Sum(parent.p_m, Rotate(world, along));
  const Turn shown = ThroughMatrix(world);
  placed.X_WL = {{placed.p_m.x, placed.p_m.y, placed.p_m.z},
                 Eigen::Quaterniond(shown.w, shown.x, shown.y, shown.z)};
  return placed;
}

}  // namespace prehend::harness::episodes

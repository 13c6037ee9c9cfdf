// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/rigid_motion.h. The formulas and their order are those of Bullet
// (btTransformUtil::integrateTransform, btMultiBody::forwardKinematics), so that the last bits
// agree. Tested by tests/harness/episode/frames/columns_test.cc
#include "harness/episode/frames/rigid_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "physics/base/portable_math.h"

namespace prehend::episode {
namespace {

// All functions with it are inlined, so how it would be handed over does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Several doubles; operators work on each of them.
using Wide = double __attribute__((vector_size(sizeof(Lanes))));

template <typename T>
struct VectorOf {
  T x, y, z;
};

template <typename T>
struct TurnOf {
  T x, y, z, w;
};

// In the loops of this file a call costs as much as its work, so much is inlined.

template <typename T, typename A, typename B>
[[gnu::always_inline]] inline TurnOf<T> Product(const A& a, const B& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
      a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

template <typename T, typename V>
[[gnu::always_inline]] inline VectorOf<T> Rotate(const TurnOf<T>& q, const V& v) {
  const TurnOf<T> half = {q.w * v.x + q.y * v.z - q.z * v.y, q.w * v.y + q.z * v.x - q.x * v.z,
                          q.w * v.z + q.x * v.y - q.y * v.x, -q.x * v.x - q.y * v.y - q.z * v.z};
  const TurnOf<T> back = {-q.x, -q.y, -q.z, q.w};  // of the product with it, w is 0
  return {half.w * back.x + half.x * back.w + half.y * back.z - half.z * back.y,
          half.w * back.y + half.y * back.w + half.z * back.x - half.x * back.z,
          half.w * back.z + half.z * back.w + half.x * back.y - half.y * back.x};
}

double LengthOf(const Vector3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

[[gnu::always_inline]] inline double Root(double x) { return std::sqrt(x); }
[[gnu::always_inline]] inline Wide Root(const Wide& x) {
  return Wide{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}
[[gnu::always_inline]] inline bool ArePositive(const Wide& x) {
  return x[0] > 0 && x[1] > 0 && x[2] > 0 && x[3] > 0;
}

/// A rotation matrix from a quaternion.
template <typename T>
struct MatrixOf {
  std::array<std::array<T, 3>, 3> m;

  [[gnu::always_inline]] inline explicit MatrixOf(const TurnOf<T>& q) {
    const T s = 2.0 / (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const T xs = q.x * s, ys = q.y * s, zs = q.z * s;
    const T wx = q.w * xs, wy = q.w * ys, wz = q.w * zs;
    const T xx = q.x * xs, xy = q.x * ys, xz = q.x * zs;
    const T yy = q.y * ys, yz = q.y * zs, zz = q.z * zs;
    m = {{{1.0 - (yy + zz), xy - wz, xz + wy},
          {xy + wz, 1.0 - (xx + zz), yz - wx},
          {xz - wy, yz + wx, 1.0 - (xx + yy)}}};
  }
  [[gnu::always_inline]] inline T Trace() const { return m[0][0] + m[1][1] + m[2][2]; }
  /// Its quaternion, if the trace is positive.
  [[gnu::always_inline]] inline TurnOf<T> TurnByTrace(const T& trace) const {
    const T root = Root(trace + 1.0), scale = 0.5 / root;
    return {(m[2][1] - m[1][2]) * scale, (m[0][2] - m[2][0]) * scale, (m[1][0] - m[0][1]) * scale,
            root * 0.5};
  }
};

/// The quaternion after its way through a rotation matrix.
Turn ThroughMatrix(const TurnOf<double>& q) {
  const MatrixOf<double> matrix(q);
  const auto& m = matrix.m;
  const double trace = matrix.Trace();
  if (trace > 0) {
    const TurnOf<double> turn = matrix.TurnByTrace(trace);
    return {turn.x, turn.y, turn.z, turn.w};
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

[[gnu::always_inline]] inline TurnOf<Wide> ThroughMatrices(const TurnOf<Wide>& q) {
  const MatrixOf<Wide> matrix(q);
  const Wide trace = matrix.Trace();
  if (ArePositive(trace)) return matrix.TurnByTrace(trace);
  TurnOf<Wide> turns{};
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Turn turn = ThroughMatrix({q.x[i], q.y[i], q.z[i], q.w[i]});
    turns.x[i] = turn.x, turns.y[i] = turn.y, turns.z[i] = turn.z, turns.w[i] = turn.w;
  }
  return turns;
}

[[gnu::always_inline]] inline Wide Broadcast(double x) { return Wide{x, x, x, x}; }
[[gnu::always_inline]] inline Wide Load(const Lanes& lanes) {
  Wide wide;
  std::memcpy(&wide, &lanes, sizeof(wide));
  return wide;
}
[[gnu::always_inline]] inline void Store(const Wide& wide, Lanes& lanes) {
  std::memcpy(&lanes, &wide, sizeof(wide));
}

}  // namespace

Turn ToTurn(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
Vector3 ToVector3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Turn Inverse(const Turn& q) { return {-q.x, -q.y, -q.z, q.w}; }

Vector3 Rotated(const Turn& q, const Vector3& v) {
  const VectorOf<double> rotated = Rotate(TurnOf<double>{q.x, q.y, q.z, q.w}, v);
  return {rotated.x, rotated.y, rotated.z};
}

Turn Turned(const Turn& before, const Vector3& w_rad_per_s, double dt_s) {
  const Vector3& w = w_rad_per_s;
  constexpr double kLargestTurn = 0.25 * std::numbers::pi;
  double speed = LengthOf(w);
  if (speed * dt_s > kLargestTurn) speed = kLargestTurn / dt_s;
  const double scale = speed < 0.001
                           ? 0.5 * dt_s - (dt_s * dt_s * dt_s) * 0.020833333333 * speed * speed
                           : std::sin(0.5 * speed * dt_s) / speed;
  const Turn change = {w.x * scale, w.y * scale, w.z * scale, std::cos(speed * dt_s * 0.5)};
  TurnOf<double> after = Product<double>(change, before);
  const double shrink = 1.0 / std::sqrt(after.x * after.x + after.y * after.y + after.z * after.z +
                                        after.w * after.w);
  after = {after.x * shrink, after.y * shrink, after.z * shrink, after.w * shrink};
  return ThroughMatrix(after);
}

void PlacedLinks::PutPalm(std::size_t lane, const physics::Pose& X_WPalm) {
  const Turn back = Inverse(ToTurn(X_WPalm.q));
  turn[0][lane] = back.x, turn[1][lane] = back.y, turn[2][lane] = back.z, turn[3][lane] = back.w;
  Correct(lane, X_WPalm);
}

void PlacedLinks::Correct(std::size_t lane, const physics::Pose& found) {
  X_WL[lane] = found;
  for (std::size_t i = 0; i < 3; ++i) p_m[i][lane] = found.p_m[static_cast<Eigen::Index>(i)];
}

LinkGuess::LinkGuess(const physics::HandModel& model) {
  const std::vector<physics::Pose> rest =
      physics::LinkPoses(model, std::vector<double>(model.links.size(), 0.0));
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const physics::HandLink& link = model.links[i];
    const physics::Pose& X_HL = rest[i];
    const physics::Pose X_HP =
        link.parent == physics::kNone ? physics::Pose{} : At(rest, link.parent);
    const Vector3 axis = ToVector3(X_HL.q.conjugate() * link.joint_axis);
    links_.push_back({.parent = link.parent.number(),
                      .slides = link.slides,
                      .turn = ToTurn(X_HL.q.conjugate() * X_HP.q),
                      .axis = axis,
                      .axis_length = LengthOf(axis),
                      .pivot = ToVector3(X_HP.q.conjugate() * (link.pivot_m - X_HP.p_m)),
                      .centre = ToVector3(X_HL.q.conjugate() * (X_HL.p_m - link.pivot_m))});
  }
}

void LinkGuess::Guess(std::size_t number, const PlacedLinks& parent, const Lanes& joints,
                      PlacedLinks& placed) const {
  const Link& link = links_[number];
  TurnOf<Wide> turn;
  if (link.slides) {
    const Turn& all = link.turn;
    turn = {Broadcast(all.x), Broadcast(all.y), Broadcast(all.z), Broadcast(all.w)};
  } else {
    Lanes half{}, sines{}, cosines{};
    for (std::size_t i = 0; i < kLanes; ++i) half[i] = -joints[i] * 0.5;
    physics::SinesAndCosines(half, sines, cosines);
    const Wide s = Load(sines) / link.axis_length;
    turn = Product<Wide>(
        TurnOf<Wide>{link.axis.x * s, link.axis.y * s, link.axis.z * s, Load(cosines)}, link.turn);
  }
  const VectorOf<Wide> to_pivot = Rotate(turn, link.pivot);
  VectorOf<Wide> along = {link.centre.x + to_pivot.x, link.centre.y + to_pivot.y,
                          link.centre.z + to_pivot.z};
  if (link.slides) {
    const Wide way = Load(joints);
    along = {along.x + way * link.axis.x, along.y + way * link.axis.y, along.z + way * link.axis.z};
  }
  const TurnOf<Wide> whole =
      Product<Wide>(turn, TurnOf<Wide>{Load(parent.turn[0]), Load(parent.turn[1]),
                                       Load(parent.turn[2]), Load(parent.turn[3])});
  const TurnOf<Wide> world = {-whole.x, -whole.y, -whole.z, whole.w};
  const VectorOf<Wide> way = Rotate(world, along);
  const VectorOf<Wide> p = {Load(parent.p_m[0]) + way.x, Load(parent.p_m[1]) + way.y,
                            Load(parent.p_m[2]) + way.z};
  const TurnOf<Wide> shown = ThroughMatrices(world);
  Store(whole.x, placed.turn[0]), Store(whole.y, placed.turn[1]);
  Store(whole.z, placed.turn[2]), Store(whole.w, placed.turn[3]);
  Store(p.x, placed.p_m[0]), Store(p.y, placed.p_m[1]), Store(p.z, placed.p_m[2]);
  for (std::size_t i = 0; i < kLanes; ++i) {
    placed.X_WL[i] = {{p.x[i], p.y[i], p.z[i]},
                      Eigen::Quaterniond(shown.w[i], shown.x[i], shown.y[i], shown.z[i])};
  }
}

}  // namespace prehend::episode

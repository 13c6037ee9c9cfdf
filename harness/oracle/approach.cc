// SPDX-License-Identifier: Apache-2.0
// Distances between convex shapes are found by alternating projections (Cheney & Goldstein 1959):
// the nearest point of one shape to the nearest point of the other to ... converges to a nearest
// pair. It needs nothing but the nearest point of a shape, and a hundredth of a millimetre is
// plenty here.
#include "harness/oracle/approach.h"

#include <algorithm>
#include <limits>

namespace prehend::harness::oracle {

namespace {

constexpr int kMaxProjections = 200;
constexpr double kProjectionAccuracy_m = 1e-5;

using Eigen::Vector3d;

Vector3d PulledInto(double radius, const Vector3d& centre, const Vector3d& p) {
  const Vector3d out = p - centre;
  const double distance = out.norm();
  return distance > radius ? Vector3d(centre + out * (radius / distance)) : p;
}

/// The nearest point of a solid shape to p, all in the shape's frame.
struct Nearest {
  Vector3d p;

  Vector3d operator()(const physics::Box& box) const {
    return p.cwiseMax(-box.size_m / 2).cwiseMin(box.size_m / 2);
  }
  Vector3d operator()(const physics::Sphere& sphere) const {
    return PulledInto(sphere.radius_m, Vector3d::Zero(), p);
  }
  Vector3d operator()(const physics::Cylinder& cylinder) const {
    const double half = cylinder.length_m / 2;
    Vector3d near = PulledInto(cylinder.radius_m, {0, 0, p.z()}, p);
    near.z() = std::clamp(p.z(), -half, half);
    return near;
  }
  Vector3d operator()(const physics::Capsule& capsule) const {
    const double half = capsule.length_m / 2;
    return PulledInto(capsule.radius_m, {0, 0, std::clamp(p.z(), -half, half)}, p);
  }
  Vector3d operator()(const physics::Hull& hull) const { return physics::NearestIn(hull, p); }
};

struct Solid {
  physics::Shape shape;
  physics::Pose X_WS;

  Vector3d NearestTo(const Vector3d& p_W) const {
    return X_WS * std::visit(Nearest{X_WS.inverse() * p_W}, shape);
  }
};

double Distance(const Solid& a, const Solid& b) {
  Vector3d on_b = b.X_WS.p_m;
  double distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxProjections; ++i) {
    const Vector3d on_a = a.NearestTo(on_b);
    on_b = b.NearestTo(on_a);
    const double closer = (on_a - on_b).norm();
    if (distance - closer < kProjectionAccuracy_m) return closer;
    distance = closer;
  }
  return distance;
}

std::vector<Solid> PartsOf(const physics::HandModel& model, const physics::HandState& hand) {
  std::vector<Solid> parts = {{physics::Box{model.palm_size_m}, hand.palm.X_WB}};
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const physics::HandLink& link = model.links[i];
    const Vector3d size(link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m);
    parts.push_back({physics::Box{size}, hand.X_WL[i]});
  }
  return parts;
}

/// How fast palm and fingers moved since the frame before: the fastest of them. A hand that only
/// closes its fingers around the object is not idle; one to which the object is brought is.
double Motion_m_per_s(const Recording& recording, int hand, int frame) {
  const physics::HandState &now = recording.hand(hand, frame),
                           &before = recording.hand(hand, frame - 1);
  double farthest = (now.palm.X_WB.p_m - before.palm.X_WB.p_m).norm();
  for (std::size_t i = 0; i < now.X_WL.size(); ++i)
    farthest = std::max(farthest, (now.X_WL[i].p_m - before.X_WL[i].p_m).norm());
  return farthest / recording.Seconds(frame - 1, frame);
}

/// The frame at which the hand last stopped idling, or `earliest`: where it began to move, slowly
/// at first.
int LastIdleEnd(const Recording& recording, const OracleSettings& settings, int hand, int earliest,
                int touch) {
  int idle_end = earliest;
  int still_since = earliest;
  for (int frame = earliest + 1; frame < touch; ++frame) {
    if (Motion_m_per_s(recording, hand, frame) >= settings.idle_speed_m_per_s) still_since = frame;
    if (recording.Seconds(still_since, frame) > settings.reach_idle_s) idle_end = frame;
  }
  while (idle_end > earliest &&
         Motion_m_per_s(recording, hand, idle_end) > settings.onset_speed_m_per_s)
    --idle_end;
  return idle_end;
}

}  // namespace

int ApproachBegin(std::span<const DistanceAt> path, double dead_band_m,
                  const OracleSettings& settings) {
  const auto away_m = [&](int from, int to) { return path[to].distance_m - path[from].distance_m; };
  const auto duration_s = [&](int from, int to) { return path[to].t_s - path[from].t_s; };
  const int last = static_cast<int>(path.size()) - 1;
  int turn = last, retreat = last;
  while (retreat >= 0 && away_m(retreat, turn) <= dead_band_m) {
    if (away_m(retreat, turn) < 0) turn = retreat;
    --retreat;
  }
  if (retreat < 0) return 0;
  int back = turn;
  while (back < last &&
         away_m(back + 1, back) <= settings.idle_speed_m_per_s * duration_s(back, back + 1))
    ++back;
  if (duration_s(turn, back) <= settings.turn_pause_s) return turn;
  while (back > turn &&
         away_m(back, back - 1) > settings.onset_speed_m_per_s * duration_s(back - 1, back))
    --back;
  return back;
}

double SurfaceDistance(const physics::HandModel& model, const physics::HandState& hand,
                       const physics::Body& body, const physics::BodyState& state) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Solid& part : PartsOf(model, hand))
    for (const physics::PlacedShape& placed : body.shapes)
      distance = std::min(distance, Distance(part, {placed.shape, state.X_WB * placed.X_BS}));
  return distance;
}

bool InReachRegion(const physics::HandModel& model, const physics::HandState& hand,
                   const physics::Body& body, const physics::BodyState& state, double radius_m) {
  const physics::LocalBox box = physics::BoundingBox(body);
  const Vector3d centre_W = hand.palm.X_WB * Vector3d(radius_m * model.ahead);
  const Vector3d centre_C = state.X_WB.inverse() * centre_W - box.p_BC_m;
  const Vector3d nearest = Nearest{centre_C}(physics::Box{2 * box.half_size_m});
  return (centre_C - nearest).norm() <= radius_m;
}

int ReachBegin(const Recording& recording, const OracleSettings& settings, int hand, int body,
               int earliest, int touch) {
  const physics::HandModel& model = recording.scene.hands[hand].model;
  const physics::Body& shape = recording.scene.bodies[body];
  int begin = touch;
  while (begin > earliest &&
         InReachRegion(model, recording.hand(hand, begin - 1), shape,
                       recording.body(body, begin - 1), settings.reach_radius_m))
    --begin;
  begin = LastIdleEnd(recording, settings, hand, begin, touch);
  std::vector<DistanceAt> path;
  for (int frame = begin; frame < touch; ++frame)
    path.push_back(
        {recording.Seconds(begin, frame),
         SurfaceDistance(model, recording.hand(hand, frame), shape, recording.body(body, frame))});
  begin += ApproachBegin(path, settings.reach_dead_band_m, settings);
  // Standing still is no reach yet, nor is what settles before the hand moves: it begins with the
  // movement, slowly at first.
  const auto motion_m_per_s = [&](int frame) { return Motion_m_per_s(recording, hand, frame); };
  int moves = begin;
  while (moves < touch && motion_m_per_s(moves + 1) < settings.idle_speed_m_per_s) ++moves;
  while (moves > begin && motion_m_per_s(moves) > settings.onset_speed_m_per_s) --moves;
  begin = moves;
  return begin;
}

}  // namespace prehend::harness::oracle

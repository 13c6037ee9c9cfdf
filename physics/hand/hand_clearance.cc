// SPDX-License-Identifier: Apache-2.0
// Distances are exact for spheres against the shapes of physics/scene/geometry.h.
#include "physics/hand/hand_clearance.h"

#include <algorithm>
#include <cmath>

#include "physics/scene/geometry.h"

namespace prehend::physics {
namespace {

constexpr int kBallsPerPalmEdge = 5;
constexpr int kMinBallsPerLink = 3;
/// Largest distance between neighbouring spheres on a link, in radii.
constexpr double kBallsApart_radii = 4;
/// Radius of the spheres at the corners of a jaw's end, which is not round like a fingertip.
constexpr double kCorner_m = 0.001;
/// Time step of the samples: one centimetre at 1.5 m/s, the peak speed of a long reach.
constexpr int kLooks = 120;

/// Whether a body is a part of the person whose hand this is. Parts stand together in a scene, from
/// the head on.
bool IsPartOfOwner(const Scene& scene, HandIndex hand, BodyIndex body) {
  if (!scene.body(body).kinematic) return false;
  const Person* person = nullptr;
  for (const Person& other : scene.persons) {
    if (other.head <= body && (!person || other.head > person->head)) person = &other;
  }
  return person && (person->right_hand == hand || person->left_hand == hand);
}

}  // namespace

HandClearance::HandClearance(const Scene& scene, HandIndex hand, const std::vector<double>& joints)
    : scene_(scene) {
  const HandModel& model = scene.hand(hand).model;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyIndex body(i);
    if (scene.body(body).abstract != Abstract::kNot) continue;
    if (!IsPartOfOwner(scene, hand, body)) obstacles_.push_back(body);
  }
  const Eigen::Vector3d half = model.palm_size_m / 2;
  const double palm_radius = half.z();
  for (int i = 0; i < kBallsPerPalmEdge; ++i) {
    for (int k = 0; k < kBallsPerPalmEdge; ++k) {
      const double x = 2.0 * i / (kBallsPerPalmEdge - 1) - 1,
                   y = 2.0 * k / (kBallsPerPalmEdge - 1) - 1;
      balls_.push_back(
          {{x * (half.x() - palm_radius), y * (half.y() - palm_radius), 0}, palm_radius});
    }
  }
  const std::vector<Pose> X_HL = LinkPoses(model, joints);
  for (std::size_t i = 0; i < X_HL.size(); ++i) {
    const HandLink& link = model.links[i];
    const double radius = link.half_thickness_m;
    const double half_length = std::max(link.length_m / 2 - radius, 0.0);
    const int gaps = static_cast<int>(std::ceil(2 * half_length / (kBallsApart_radii * radius)));
    const int last = std::max(gaps, kMinBallsPerLink - 1);
    for (int k = 0; k <= last; ++k) {
      const double x = half_length * (2.0 * k / last - 1);
      balls_.push_back({X_HL[i] * Eigen::Vector3d(x, 0, 0), radius});
    }
    if (!link.slides) continue;
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d corner(link.length_m / 2 - kCorner_m, 0,
                                   side * (link.half_thickness_m - kCorner_m));
      balls_.push_back({X_HL[i] * corner, kCorner_m});
    }
  }
  for (Ball& ball : balls_) {
    ball.reach_m = ball.p_H_m.norm() + ball.radius_m;
    reach_m_ = std::max(reach_m_, ball.reach_m);
  }
}

double HandClearance::At(const Pose& X_WH, const Snapshot& now) const {
  double least = kFar_m;
  for (const BodyIndex body : obstacles_) least = LessTo(body, X_WH, now, least);
  return least;
}

double HandClearance::To(BodyIndex body, const Pose& X_WH, const Snapshot& now) const {
  return LessTo(body, X_WH, now, kFar_m);
}

double HandClearance::LessTo(BodyIndex body, const Pose& X_WH, const Snapshot& now,
                             double least) const {
  for (const PlacedShape& placed : scene_.body(body).shapes) {
    const Pose X_SH = (now.body(body).X_WB * placed.X_BS).inverse() * X_WH;
    const double distance_m = SignedDistance(placed.shape, X_SH.p_m);
    if (distance_m > reach_m_ + least) continue;
    for (const Ball& ball : balls_)
      if (distance_m <= ball.reach_m + least)
        least = std::min(least, SignedDistance(placed.shape, X_SH * ball.p_H_m) - ball.radius_m);
  }
  return least;
}

HandClearance::Nearest HandClearance::NearestAlong(const Segment& segment, const Snapshot& now,
                                                   BodyIndex but) const {
  Trajectory trajectory({});
  trajectory.Append(segment);
  Nearest nearest;
  for (int i = 1; i <= kLooks; ++i) {
    const Pose X_WH = trajectory.At(segment.duration_s * i / kLooks).X_WH;
    for (const BodyIndex body : obstacles_) {
      if (body == but) continue;
      const double distance_m = LessTo(body, X_WH, now, nearest.distance_m);
      if (distance_m < nearest.distance_m) nearest = {distance_m, body};
    }
  }
  return nearest;
}

double HandClearance::Along(const Segment& segment, const Snapshot& now) const {
  Trajectory trajectory({});
  trajectory.Append(segment);
  double least = kFar_m;
  // From its end on, where things are near: what is farther than that costs next to nothing.
  for (int i = kLooks; i >= 1; --i) {
    const Pose X_WH = trajectory.At(segment.duration_s * i / kLooks).X_WH;
    for (const BodyIndex body : obstacles_) least = LessTo(body, X_WH, now, least);
  }
  return least;
}

}  // namespace prehend::physics

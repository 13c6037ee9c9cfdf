// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/contact_guess.h. Tested by tests/harness/episode/frames/frames_test.cc
#include "harness/episode/frames/contact_guess.h"

#include <algorithm>
#include <cmath>

namespace prehend::episode {
namespace {

/// By which Bullet rounds the edges of boxes and cylinders here.
constexpr double kEdgeRadius_m = 0.001;

double Component(const Vector3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

Vector3 Minus(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

double SquaredLength(const Vector3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

}  // namespace

int LargestOf(const Vector3& n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  if (x >= y && x >= z) return 0;
  return y >= z ? 1 : 2;
}

double LargestGuess(int largest, const Vector3& before, const Vector3& now) {
  double left = 1;
  bool same = true;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == largest) continue;
    const double value = Component(now, axis);
    left -= value * value;
    same = same && value == Component(before, axis);
  }
  const double last = Component(before, largest);
  return same ? last : std::copysign(std::sqrt(std::max(left, 0.0)), last);
}

std::array<Vector3, 2> PlacesFor(const PlacedNormal& before, const physics::Pose& from,
                                 const physics::Pose& to, double outward, const Vector3& n) {
  const Turn back = Inverse(ToTurn(from.q)), onward = ToTurn(to.q);
  const Vector3 kept = Rotated(onward, Rotated(back, Minus(before.p, ToVector3(from.p_m))));
  const Vector3 p = {kept.x + to.p_m.x(), kept.y + to.p_m.y(), kept.z + to.p_m.z()};
  const Vector3 way = Minus(n, Rotated(onward, Rotated(back, before.n)));
  const double radius = outward * kEdgeRadius_m;
  return {p, {p.x + radius * way.x, p.y + radius * way.y, p.z + radius * way.z}};
}

PlaceRule BestRule(const std::array<Vector3, 2>& places, const Vector3& found) {
  return SquaredLength(Minus(found, places[1])) < SquaredLength(Minus(found, places[0]))
             ? PlaceRule::kRounded
             : PlaceRule::kKept;
}

}  // namespace prehend::episode

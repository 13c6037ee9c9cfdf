// SPDX-License-Identifier: Apache-2.0
// The signed distance of a convex shape is a convex function, so along the axis of a capsule it has
// one minimum, found by the golden section. Tested by tests/physics/person/fixed_things_test.cc
#include <algorithm>
#include <cmath>

#include "physics/person/gaze.h"
#include "physics/scene/geometry.h"
#include "physics/world/contact_hold.h"

namespace prehend::physics {
namespace {

/// After so many steps the place on an axis of a metre is known to 0.1 mm.
constexpr int kSteps = 20;
/// What is nearer touches: she stops just before it.
constexpr double kTouch_m = 1e-4;
/// What ends at most so far above her feet is what she stands on.
constexpr double kFloor_m = 0.03;
/// For slopes of the distance.
constexpr double kSlope_m = 1e-6;

/// The point of the axis from `a` to `b` (in the shape's frame) that is deepest in a shape.
Eigen::Vector3d Deepest(const Shape& shape, Eigen::Vector3d a, Eigen::Vector3d b) {
  constexpr double kGolden = 0.6180339887498949;
  Eigen::Vector3d c = b - kGolden * (b - a), d = a + kGolden * (b - a);
  double at_c = SignedDistance(shape, c), at_d = SignedDistance(shape, d);
  for (int i = 0; i < kSteps; ++i) {
    if (at_c < at_d) {
      b = d, d = c, at_d = at_c;
      c = b - kGolden * (b - a);
      at_c = SignedDistance(shape, c);
    } else {
      a = c, c = d, at_c = at_d;
      d = a + kGolden * (b - a);
      at_d = SignedDistance(shape, d);
    }
  }
  return at_c < at_d ? c : d;
}

Eigen::Vector3d OutOf(const Shape& shape, const Eigen::Vector3d& p_S) {
  Eigen::Vector3d slope;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kSlope_m * Eigen::Vector3d::Unit(i);
    slope[i] = SignedDistance(shape, p_S + step) - SignedDistance(shape, p_S - step);
  }
  return slope.norm() > 0 ? Eigen::Vector3d(slope.normalized()) : Eigen::Vector3d::UnitZ();
}

}  // namespace

FixedThings::FixedThings(const Scene& scene) : scene_(scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed && body.abstract == Abstract::kNot)
      things_.push_back({BodyIndex(i), WorldBounds(body, body.X_WB)});
  }
}

std::vector<FixedTouch> FixedThings::TouchedBy(const Person& person,
                                               const std::vector<Pose>& places) const {
  std::vector<FixedTouch> touches;
  const double floor_m = person.X_WS.p_m.z() + kFloor_m;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Body& part = scene_.body(person.head + static_cast<int>(i));
    const auto& capsule = std::get<Capsule>(part.shapes.front().shape);
    const Pose X_WC = places[i] * part.shapes.front().X_BS;
    const Eigen::Vector3d half = X_WC.q * Eigen::Vector3d(0, 0, capsule.length_m / 2);
    const Eigen::AlignedBox3d bounds = WorldBounds(part, places[i]);
    for (const Thing& thing : things_) {
      if (thing.bounds_W_m.squaredExteriorDistance(bounds) > kTouch_m * kTouch_m ||
          thing.bounds_W_m.max().z() <= floor_m)
        continue;
      const Body& body = scene_.body(thing.body);
      FixedTouch deepest{.part = static_cast<int>(i), .thing = thing.body, .depth_m = -HUGE_VAL};
      for (const PlacedShape& placed : body.shapes) {
        const Pose X_WS = body.X_WB * placed.X_BS, X_SW = X_WS.inverse();
        const Eigen::Vector3d p_S =
            Deepest(placed.shape, X_SW * (X_WC.p_m - half), X_SW * (X_WC.p_m + half));
        const double depth_m = capsule.radius_m - SignedDistance(placed.shape, p_S);
        if (depth_m < -kTouch_m || depth_m <= deepest.depth_m) continue;
        deepest.depth_m = depth_m;
        deepest.nhat_W = X_WS.q * OutOf(placed.shape, p_S);
        deepest.p_W_m = X_WS * p_S - capsule.radius_m * deepest.nhat_W;
      }
      if (deepest.depth_m >= -kTouch_m) touches.push_back(deepest);
    }
  }
  return touches;
}

void AddContacts(const Person& person, const std::vector<FixedTouch>& touches, Snapshot& snapshot) {
  if (touches.empty()) return;
  for (const FixedTouch& touch : touches) {
    ContactPoint contact{.a = {.body = person.head + touch.part},
                         .b = {.body = touch.thing},
                         .p_W_m = touch.p_W_m,
                         .nhat_BA_W = touch.nhat_W,
                         .distance_m = -touch.depth_m};
    if (contact.b < contact.a) {
      std::swap(contact.a, contact.b);
      contact.nhat_BA_W = -contact.nhat_BA_W;
    }
    snapshot.contacts.push_back(contact);
  }
  std::ranges::sort(snapshot.contacts, ComesBefore);
}

}  // namespace prehend::physics

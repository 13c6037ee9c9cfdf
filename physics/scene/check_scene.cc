// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/check_scene.h"

#include <algorithm>
#include <cmath>

namespace prehend::physics {
namespace {

constexpr double kUnit = 1e-6;  ///< how far a length may be from 1

bool IsUnit(const Eigen::Vector3d& v) { return std::abs(v.norm() - 1) < kUnit; }
bool IsPose(const Pose& X) {
  return X.p_m.allFinite() && std::abs(X.q.norm() - 1) < kUnit;  // false of what is not finite
}

template <typename Thing>
bool IsNoneOrBelow(Index<Thing> index, std::size_t size) {
  return index == kNone || index.IsBelow(size);
}

void CheckBody(const Body& body) {
  PREHEND_CHECK(IsPose(body.X_WB) && std::isfinite(body.mass_kg) && body.mass_kg >= 0);
  for (const PlacedShape& placed : body.shapes) PREHEND_CHECK(IsPose(placed.X_BS));
  PREHEND_CHECK(!body.grains || !body.grains->p_WG_m.empty());
}

void CheckJoint(const Joint& joint, std::size_t bodies) {
  PREHEND_CHECK(joint.body.IsBelow(bodies) && joint.base.IsBelow(bodies));
  PREHEND_CHECK(joint.body != joint.base);
  PREHEND_CHECK(joint.pivot_W_m.allFinite() && IsUnit(joint.axis_W));
  PREHEND_CHECK(joint.lower <= 0 && joint.upper >= 0);
}

void CheckModel(const HandModel& model) {
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const HandLink& link = model.links[i];
    PREHEND_CHECK(IsNoneOrBelow(link.parent, i));  // a parent comes before its links
    PREHEND_CHECK(IsUnit(link.direction) && IsUnit(link.joint_axis));
    PREHEND_CHECK(link.pivot_m.allFinite() && link.lower <= link.upper);
  }
  for (const GraspStyle& style : model.styles) {
    PREHEND_CHECK(style.frames.size() >= 2 && style.effort.size() == model.links.size());
    for (const auto& frame : style.frames) PREHEND_CHECK(frame.size() == model.links.size());
  }
}

bool IsSideOf(const Scene& scene, const ContactSide& side) {
  if (side.hand == kNone) return side.body.IsBelow(scene.bodies.size()) && side.link == kNone;
  return side.body == kNone && side.hand.IsBelow(scene.hands.size()) &&
         IsNoneOrBelow(side.link, scene.hand(side.hand).model.links.size());
}

}  // namespace

void CheckScene(const Scene& scene) {
  PREHEND_CHECK(scene.world.rate_hz > 0);
  for (const Body& body : scene.bodies) CheckBody(body);
  for (const Joint& joint : scene.joints) CheckJoint(joint, scene.bodies.size());
  for (const Hand& hand : scene.hands) {
    PREHEND_CHECK(IsPose(hand.X_WH));
    CheckModel(hand.model);
  }
  for (const Person& person : scene.persons) {
    PREHEND_CHECK(person.head.IsBelow(scene.bodies.size()) && IsPose(person.X_WS));
    PREHEND_CHECK(IsNoneOrBelow(person.right_hand, scene.hands.size()));
    PREHEND_CHECK(IsNoneOrBelow(person.left_hand, scene.hands.size()));
  }
}

bool IsOf(const Scene& scene, const Snapshot& snapshot) {
  for (const auto& contacts : snapshot.AllContacts())
    for (const ContactPoint& contact : contacts)
      if (!IsSideOf(scene, contact.a) || !IsSideOf(scene, contact.b)) return false;
  for (const GazeState& gaze : snapshot.gazes)
    if (!IsNoneOrBelow(gaze.body, scene.bodies.size()) ||
        !IsNoneOrBelow(gaze.hand, scene.hands.size()))
      return false;
  const auto fits = [](const Hand& hand, const HandState& now) {
    return now.joints.size() == hand.model.links.size() && now.X_WL.size() == now.joints.size();
  };
  return snapshot.bodies.size() == scene.bodies.size() &&
         snapshot.joints.size() == scene.joints.size() &&
         snapshot.gazes.size() == scene.persons.size() &&
         std::ranges::equal(scene.hands, snapshot.hands, fits);
}

}  // namespace prehend::physics

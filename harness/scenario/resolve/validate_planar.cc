// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/validate_planar_test.cc
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "harness/scenario/resolve/resolve.h"
#include "physics/scene/planar.h"

namespace prehend::scenario {
namespace {

constexpr double kOnPlane_m = 1e-6;

/// The hint for a position or a displacement.
constexpr const char* kZeroY = "y must be 0 in a planar world";

const char* RemedyFor(physics::JointKind kind) {
  return kind == physics::JointKind::kSlider ? "axis: [x, 0, z]" : "hinge with axis: [0, 1, 0]";
}

/// Checks for each actor's steps whether they stay in the plane.
struct StepCheck {
  const physics::Scene& scene;
  const physics::Hand& hand;
  DiagnosticList& errors;

  void operator()(const ReachYaml& e) const {
    CheckWay("offset_m", e.offset_m.value.y(), e.offset_m.where);
    for (const physics::Body& body : scene.bodies) {
      if (e.point_m && body.name == e.reach.value)
        CheckWay("point_m", (body.X_WB * e.point_m->value).y(), e.point_m->where);
    }
  }
  void operator()(const MoveYaml& e) const {
    CheckWay("move_by_m", e.move_by_m.value.y(), e.move_by_m.where);
  }
  void operator()(const CarryYaml& e) const {
    CheckWay("carry_to_m", e.carry_to_m.value.y(), e.carry_to_m.where);
  }
  void operator()(const PosesYaml& e) const {
    for (const PoseYaml& pose : e.poses) {
      CheckWay("at_m", pose.at_m.y(), pose.where);
      const Eigen::Vector3d y = pose.q * Eigen::Vector3d::UnitY();
      if ((y - hand.X_WH.q * Eigen::Vector3d::UnitY()).norm() > kOnPlane_m)
        errors.Add(pose.where, "this pose turns the hand out of the plane y = 0",
                   "a hand turns about y only: rpy_deg: [0, pitch, 0]");
    }
  }
  void operator()(const RecordingYaml& e) const {
    errors.Add(e.recording.where, "a recorded motion does not stay in the plane y = 0",
               "write the motion as way-points: poses: [..]");
  }
  void operator()(const TurnHandYaml& e) const {
    if (e.turn_by_deg.value.x() != 0 || e.turn_by_deg.value.z() != 0)
      errors.Add(e.turn_by_deg.where, "turn_by_deg: this turns the hand out of the plane y = 0",
                 "a hand turns about y only: [0, degrees, 0]");
  }
  void operator()(const OrbitYaml& e) const {
    errors.Add(e.orbit.around.where, "orbit: this leaves the plane y = 0", kZeroY);
  }
  void operator()(const PressYaml& e) const { CheckWay("along", e.along.value.y(), e.along.where); }
  /// They keep to the plane by themselves; persons are refused as a whole.
  void operator()(const physics::OneOf<CloseYaml, OpenYaml, LiftYaml, PlaceYaml, RetreatYaml,
                                       FollowJointYaml, WaitYaml> auto&) const {}
  void operator()(const StepOfPerson auto&) const {}

 private:
  void CheckWay(const char* key, double y, const Where& where) const {
    if (std::abs(y) > kOnPlane_m)
      errors.Add(where, fmt::format("{}: this leaves the plane y = 0", key), kZeroY);
  }
};

void CheckBodies(const ScenarioYaml& entry, const physics::Scene& scene, DiagnosticList& errors) {
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const physics::Body& body = scene.bodies[i];
    const std::string why = physics::WhyNotPlanar(body);
    if (why.empty()) continue;
    const bool beside = !body.grains && std::abs(body.X_WB.p_m.y()) > kOnPlane_m;
    errors.Add(beside ? entry.entities[i].value.at_m.where : entry.entities[i].name_where,
               fmt::format("'{}' does not fit a planar world: {}", body.name, why),
               beside ? kZeroY
                      : "rotate it about y only, and keep its parts in the plane; see "
                        "docs/scenario-format.md");
  }
}

void CheckJoints(const ScenarioYaml& entry, const physics::Scene& scene, DiagnosticList& errors) {
  for (const physics::Joint& joint : scene.joints) {
    const std::string why = physics::WhyNotPlanar(joint);
    if (why.empty()) continue;
    const auto& named = At(entry.entities, joint.body);
    errors.Add(named.value.joint->where,
               fmt::format("the joint of '{}' does not fit a planar world: {}", named.name, why),
               RemedyFor(joint.kind));
  }
}

void CheckHand(const Named<HandActorYaml>& actor, const physics::Hand& hand,
               DiagnosticList& errors) {
  if (const std::string why = physics::WhyNotPlanar(hand.model); !why.empty())
    errors.Add(actor.value.hand.where,
               fmt::format("hand '{}' does not fit a planar world: {}", hand.model.name, why),
               "use the hand 'planar_gripper'");
  if (std::abs(hand.X_WH.p_m.y()) > kOnPlane_m)
    errors.Add(actor.value.at_m.where,
               fmt::format("at_m: '{}' starts outside the plane y = 0", actor.name), kZeroY);
  else if (!physics::KeepsPlane(hand.X_WH))
    errors.Add(actor.name_where, fmt::format("'{}' is turned out of the plane y = 0", actor.name),
               "a hand turns about y only: rpy_deg: [0, pitch, 0]");
}

}  // namespace

void ValidatePlanar(const ScenarioYaml& entry, const physics::Scene& scene,
                    DiagnosticList& errors) {
  CheckBodies(entry, scene, errors);
  CheckJoints(entry, scene, errors);
  std::map<std::string, const physics::Hand*> hands;
  for (std::size_t i = 0; i < scene.hands.size(); ++i) {
    CheckHand(entry.hands[i], scene.hands[i], errors);
    hands[entry.hands[i].name] = &scene.hands[i];
  }
  for (const Named<PersonActorYaml>& person : entry.persons)
    errors.Add(person.name_where,
               fmt::format("'{}' is a person; a planar world has no persons", person.name),
               "remove 'planar: true' and use engine: bullet");
  for (const StageYaml& stage : entry.script) {
    for (const Named<StepYaml>& step : stage) {
      const auto hand = hands.find(step.name);
      if (hand != hands.end()) std::visit(StepCheck{scene, *hand->second, errors}, step.value);
    }
  }
}

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// See tests/witnesses/metamorphic/move_scenario.h. Tested by
// tests/witnesses/metamorphic/metamorphic_test.cc
#include "tests/witnesses/metamorphic/move_scenario.h"

#include <utility>

#include "harness/scenario/transform/transform.h"
#include "physics/world/mirrored_world.h"

namespace prehend::witnesses {
namespace {

using Eigen::Vector2d;
using physics::AxisInMirror;
using physics::InMirror;

void Mirror(Vector2d& ground) { ground.y() = 0.0 - ground.y(); }

void Mirror(std::vector<physics::TimedPose>& poses) {
  for (physics::TimedPose& pose : poses) pose.X_WH = InMirror(pose.X_WH);
}

struct MirrorStep {
  void operator()(physics::ReachStep& step) const {
    step.offset_m = InMirror(step.offset_m);
    if (step.point_m) step.point_m = InMirror(*step.point_m);
  }
  void operator()(physics::MoveStep& step) const { step.by_m = InMirror(step.by_m); }
  void operator()(physics::TurnHandStep& step) const { step.by_rad = AxisInMirror(step.by_rad); }
  void operator()(physics::OrbitStep& step) const { step.by_rad = -step.by_rad; }
  void operator()(physics::PressStep& step) const { step.along_W = InMirror(step.along_W); }
  void operator()(physics::CarryStep& step) const { Mirror(step.to_m); }
  void operator()(physics::PosesStep& step) const {
    for (auto& pose : step.poses) pose.X_WH = InMirror(pose.X_WH);
  }
  void operator()(physics::LookAtStep& step) const {
    if (auto* const point_m = std::get_if<Eigen::Vector3d>(&step.target))
      *point_m = InMirror(*point_m);
  }
  void operator()(physics::WalkStep& step) const { Mirror(step.to_m); }
  void operator()(physics::TurnStep& step) const { step.to_rad = -step.to_rad; }
  void operator()(physics::MoveLimbStep& step) const {
    if (step.to_m) step.to_m = InMirror(*step.to_m);
  }
  void operator()(physics::HeadPosesStep& step) const { Mirror(step.poses); }
  void operator()(physics::BodyPosesStep& step) const {
    for (physics::TimedPosture& timed : step.postures) {
      timed.posture.hips_W_m = InMirror(timed.posture.hips_W_m);
      for (Eigen::Vector3d& direction : timed.posture.directions_W) direction = InMirror(direction);
    }
  }
  /// They say nothing about the world.
  void operator()(
      const physics::OneOf<physics::WaitStep, physics::TriggerStep, physics::PlaceStep,
                           physics::RetreatStep, physics::FollowJointStep, physics::EyesStep,
                           physics::LeanStep, physics::SwayStep> auto&) const {}
};

scenario::Scenario Mirrored(scenario::Scenario scenario) {
  scenario.scene = InMirror(std::move(scenario.scene));
  for (physics::Person& person : scenario.scene.persons) person.X_WS = InMirror(person.X_WS);
  for (physics::ScriptStage& stage : scenario.script.stages) {
    for (physics::Step& step : stage.steps) std::visit(MirrorStep{}, step.action);
    for (physics::PersonStep& step : stage.person_steps) std::visit(MirrorStep{}, step.action);
  }
  for (scenario::Outcome& outcome : scenario.outcomes)
    for (scenario::Outcome::Condition& condition : outcome.conditions)
      if (auto& near_m = condition.wanted.near_m) near_m->at(1) = 0.0 - near_m->at(1);
  return scenario;
}

}  // namespace

scenario::Scenario Moved(scenario::Scenario scenario, const WorldMotion& motion) {
  return scenario::Moved(motion.mirrors ? Mirrored(std::move(scenario)) : std::move(scenario),
                         motion.X);
}

}  // namespace prehend::witnesses

// SPDX-License-Identifier: Apache-2.0
// See tests/witnesses/metamorphic/move_scenario.h. Tested by
// tests/witnesses/metamorphic/metamorphic_test.cc
#include "tests/witnesses/metamorphic/move_scenario.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/scene/mirror_image.h"

namespace prehend::witnesses {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using physics::AxisInMirror;
using physics::InMirror;
using physics::Pose;

/// What a motion does to the parts of a scenario.
struct Mover : WorldMotion {
  Vector3d Direction(const Vector3d& v) const { return X.q * (mirrors ? InMirror(v) : v); }
  Vector3d Axis(const Vector3d& v) const { return X.q * (mirrors ? AxisInMirror(v) : v); }
  /// Of a rotation about the world's axes.
  Eigen::Quaterniond Turn(const Eigen::Quaterniond& q) const {
    return X.q * (mirrors ? InMirror(q) : q) * X.q.conjugate();
  }
  Vector3d Point(const Vector3d& p) const { return X.p_m + Direction(p); }
  Pose Of(const Pose& X_WB) const { return X * (mirrors ? InMirror(X_WB) : X_WB); }
  /// In a body's own frame.
  Vector3d Own(const Vector3d& p) const { return mirrors ? InMirror(p) : p; }
  Vector2d Ground(const Vector2d& p) const { return Point({p.x(), p.y(), 0}).head<2>(); }
  double Yaw(double yaw_rad) const { return (mirrors ? -yaw_rad : yaw_rad) + Turn_rad(); }
  double Turn_rad() const { return 2 * std::atan2(X.q.z(), X.q.w()); }
};

void Move(const Mover& motion, physics::Body& body) {
  body.X_WB = motion.Of(body.X_WB);
  if (body.grains)
    for (Vector3d& p_WG_m : body.grains->p_WG_m) p_WG_m = motion.Point(p_WG_m);
  if (!motion.mirrors) return;
  for (physics::PlacedShape& placed : body.shapes) placed = InMirror(std::move(placed));
}

void Move(const Mover& motion, physics::Joint& joint) {
  joint.pivot_W_m = motion.Point(joint.pivot_W_m);
  const bool turns = joint.kind == physics::JointKind::kHinge;
  joint.axis_W = turns ? motion.Axis(joint.axis_W) : motion.Direction(joint.axis_W);
}

void Move(const Mover& motion, std::vector<physics::TimedPose>& poses) {
  for (physics::TimedPose& pose : poses) pose.X_WH = motion.Of(pose.X_WH);
}

struct MoveStep {
  const Mover& motion;
  void operator()(physics::ReachStep& step) const {
    step.offset_m = motion.Direction(step.offset_m);
    if (step.point_m) step.point_m = motion.Own(*step.point_m);
  }
  void operator()(physics::MoveStep& step) const { step.by_m = motion.Direction(step.by_m); }
  void operator()(physics::TurnHandStep& step) const {
    step.by_rad = !step.own_axes   ? motion.Axis(step.by_rad)
                  : motion.mirrors ? AxisInMirror(step.by_rad)
                                   : step.by_rad;
  }
  void operator()(physics::OrbitStep& step) const {
    if (motion.mirrors) step.by_rad = -step.by_rad;
  }
  void operator()(physics::PressStep& step) const { step.along_W = motion.Direction(step.along_W); }
  void operator()(physics::CarryStep& step) const { step.to_m = motion.Ground(step.to_m); }
  void operator()(physics::PosesStep& step) const {
    for (std::size_t i = 0; i < step.poses.size(); ++i) {
      Pose& X = step.poses[i].X_WH;
      const physics::PoseFrame frame = step.frames.empty() ? physics::PoseFrame{} : step.frames[i];
      if (!frame.own_hand && frame.name.empty())
        X = motion.Of(X);
      else if (frame.world_axes)
        X = {motion.Direction(X.p_m), frame.own_hand ? motion.Turn(X.q) : motion.Of(X).q};
      else if (motion.mirrors)
        X = InMirror(X);
    }
  }
  void operator()(physics::LookAtStep& step) const {
    if (auto* const point_m = std::get_if<Vector3d>(&step.target))
      *point_m = motion.Point(*point_m);
  }
  void operator()(physics::WalkStep& step) const { step.to_m = motion.Ground(step.to_m); }
  void operator()(physics::TurnStep& step) const { step.to_rad = motion.Yaw(step.to_rad); }
  void operator()(physics::MoveLimbStep& step) const {
    if (step.to_m) step.to_m = motion.Point(*step.to_m);
  }
  void operator()(physics::HeadPosesStep& step) const { Move(motion, step.poses); }
  void operator()(physics::BodyPosesStep& step) const {
    for (physics::TimedPosture& timed : step.postures) {
      timed.posture.hips_W_m = motion.Point(timed.posture.hips_W_m);
      for (Vector3d& direction : timed.posture.directions_W)
        direction = motion.Direction(direction);
    }
  }
  /// They say nothing about the world.
  void operator()(
      const physics::OneOf<physics::WaitStep, physics::TriggerStep, physics::PlaceStep,
                           physics::RetreatStep, physics::FollowJointStep, physics::EyesStep,
                           physics::LeanStep, physics::SwayStep> auto&) const {}
};

/// The place that an outcome asks for.
void Move(const Mover& motion, scenario::Outcome::Condition& condition) {
  if (!condition.wanted.near_m) return;
  std::vector<double>& near_m = *condition.wanted.near_m;
  const Vector3d there = motion.Point({near_m[0], near_m[1], near_m.size() > 2 ? near_m[2] : 0});
  std::copy_n(there.begin(), near_m.size(), near_m.begin());
}

}  // namespace

scenario::Scenario Moved(scenario::Scenario scenario, const WorldMotion& world_motion) {
  const Mover motion{world_motion};
  for (physics::Body& body : scenario.scene.bodies) Move(motion, body);
  for (physics::Joint& joint : scenario.scene.joints) Move(motion, joint);
  for (physics::Hand& hand : scenario.scene.hands) {
    hand.X_WH = motion.Of(hand.X_WH);
    if (motion.mirrors) hand.model = physics::Mirrored(std::move(hand.model));
  }
  for (physics::Person& person : scenario.scene.persons) person.X_WS = motion.Of(person.X_WS);
  for (physics::ScriptStage& stage : scenario.script.stages) {
    for (physics::Step& step : stage.steps) std::visit(MoveStep{motion}, step.action);
    for (physics::PersonStep& step : stage.person_steps) std::visit(MoveStep{motion}, step.action);
  }
  for (scenario::Outcome& outcome : scenario.outcomes)
    for (scenario::Outcome::Condition& condition : outcome.conditions) Move(motion, condition);
  return scenario;
}

}  // namespace prehend::witnesses

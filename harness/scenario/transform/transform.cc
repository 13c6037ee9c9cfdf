// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/transform/transform.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;
using physics::Pose;

/// A motion of the whole world: what it does to the parts of a scenario, the steps of its script
/// among them.
struct Motion {
  Pose X;

  Eigen::Vector2d Ground(const Eigen::Vector2d& p) const {
    return (X * Vector3d(p.x(), p.y(), 0)).head<2>();
  }
  /// What is not turned keeps its rotation to the last bit.
  Pose Of(const Pose& pose) const {
    return {X * pose.p_m, X.q.z() == 0 ? pose.q : (X.q * pose.q).normalized()};
  }

  void operator()(physics::Body& body) const {
    body.X_WB = Of(body.X_WB);
    if (!body.grains) return;
    for (Vector3d& p_WG_m : body.grains->p_WG_m) p_WG_m = X * p_WG_m;
  }
  void operator()(physics::Joint& joint) const {
    joint.pivot_W_m = X * joint.pivot_W_m;
    joint.axis_W = X.q * joint.axis_W;
  }
  void operator()(physics::Hand& hand) const { hand.X_WH = Of(hand.X_WH); }
  void operator()(physics::Person& person) const { person.X_WS = Of(person.X_WS); }
  void operator()(Outcome::Condition& condition) const {
    if (!condition.wanted.near_m) return;
    std::vector<double>& near_m = *condition.wanted.near_m;
    const Vector3d there = X * Vector3d(near_m[0], near_m[1], near_m.size() > 2 ? near_m[2] : 0);
    std::copy_n(there.begin(), near_m.size(), near_m.begin());
  }

  void operator()(physics::ReachStep& step) const { step.offset_m = X.q * step.offset_m; }
  void operator()(physics::MoveStep& step) const { step.by_m = X.q * step.by_m; }
  void operator()(physics::PressStep& step) const { step.along_W = X.q * step.along_W; }
  void operator()(physics::TurnHandStep& step) const {
    if (!step.own_axes) step.by_rad = X.q * step.by_rad;
  }
  void operator()(physics::CarryStep& step) const { step.to_m = Ground(step.to_m); }
  void operator()(physics::PosesStep& step) const {
    for (std::size_t i = 0; i < step.poses.size(); ++i) {
      Pose& pose = step.poses[i].X_WH;
      const physics::PoseFrame frame = step.frames.empty() ? physics::PoseFrame{} : step.frames[i];
      if (!frame.own_hand && frame.name.empty())
        pose = Of(pose);
      else if (frame.world_axes)
        pose = {X.q * pose.p_m, X.q * pose.q * (frame.own_hand ? X.q : Pose{}.q).conjugate()};
    }
  }
  void operator()(physics::LookAtStep& step) const {
    if (auto* const point_m = std::get_if<Vector3d>(&step.target)) *point_m = X * *point_m;
  }
  void operator()(physics::WalkStep& step) const { step.to_m = Ground(step.to_m); }
  void operator()(physics::TurnStep& step) const {
    step.to_rad += 2 * std::atan2(X.q.z(), X.q.w());
  }
  void operator()(physics::MoveLimbStep& step) const {
    if (step.to_m) step.to_m = X * *step.to_m;
  }
  void operator()(physics::HeadPosesStep& step) const {
    for (physics::TimedPose& pose : step.poses) pose.X_WH = Of(pose.X_WH);
  }
  void operator()(physics::BodyPosesStep& step) const {
    for (physics::TimedPosture& timed : step.postures) {
      timed.posture.hips_W_m = X * timed.posture.hips_W_m;
      for (Vector3d& direction : timed.posture.directions_W) direction = X.q * direction;
    }
  }
  /// They say nothing about the world.
  void operator()(
      const physics::OneOf<physics::WaitStep, physics::TriggerStep, physics::PlaceStep,
                           physics::RetreatStep, physics::FollowJointStep, physics::OrbitStep,
                           physics::EyesStep, physics::LeanStep, physics::SwayStep> auto&) const {}
};

/// All bodies the other way round, but those of persons, which are consecutive.
Scenario Reordered(Scenario scenario) {
  physics::Scene& scene = scenario.scene;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (!scene.bodies[i].kinematic) others.push_back(i);
  std::vector<int> place(scene.bodies.size());
  std::iota(place.begin(), place.end(), 0);
  for (std::size_t i = 0; i < others.size() / 2; ++i) {
    const std::size_t here = others[i], there = others[others.size() - 1 - i];
    std::swap(place[here], place[there]);
    std::swap(scene.bodies[here], scene.bodies[there]);
    std::swap(scenario.body_classes[here], scenario.body_classes[there]);
    std::swap(scenario.body_part_of[here], scenario.body_part_of[there]);
  }
  const auto replaced = [&](int body) {
    return body < 0 ? body : place[static_cast<std::size_t>(body)];
  };
  const auto replace = [&](physics::BodyIndex& body) {
    body = physics::BodyIndex(replaced(body.number()));
  };
  for (int& whole : scenario.body_part_of) whole = replaced(whole);
  for (physics::Joint& joint : scene.joints) replace(joint.body), replace(joint.base);
  for (Outcome& outcome : scenario.outcomes)
    for (Outcome::Condition& condition : outcome.conditions)
      replace(condition.body), replace(condition.vessel);
  return scenario;
}

Scenario WithBystander(Scenario scenario) {
  const auto add = [&](std::string name, const Vector3d& size_m, const Vector3d& p_m,
                       double mass_kg) {
    physics::Body body;
    body.name = std::move(name);
    body.shapes = {{.shape = physics::Box{size_m}}};
    body.fixed = mass_kg == 0;
    body.mass_kg = mass_kg;
    body.X_WB.p_m = p_m;
    scenario.scene.bodies.push_back(std::move(body));
    scenario.body_classes.emplace_back();
    scenario.body_part_of.push_back(grammar::kNoEntity);
  };
  add("bystanders_slab", {1, 1, 0.1}, {-14, 0, -0.05}, 0);
  add("bystander", {0.2, 0.2, 0.2}, {-14, 0, 0.1}, 1);
  return scenario;
}

}  // namespace

std::string_view NameOf(Transform transform) {
  constexpr std::string_view kNames[] = {"nudge", "shift", "far", "turn", "reorder", "bystander"};
  return kNames[static_cast<std::size_t>(transform)];
}

std::string WhyDirected(const Scenario& scenario) {
  if (scenario.scene.world.planar) return "it is planar";
  const auto trembles = [](const physics::Hand& hand) {
    return hand.tracking && (hand.tracking->jitter_mm > 0 || hand.tracking->jitter_deg > 0 ||
                             hand.tracking->tremor_mm > 0);
  };
  if (std::ranges::any_of(scenario.scene.hands, trembles))
    return "the noise of its tracker is drawn along the axes of the world";
  if (scenario.sensing.sensors.IsPerfect()) return "";
  return "the noise of its sensors is drawn along the axes of the world";
}

tl::expected<Scenario, std::string> Transformed(Scenario scenario, Transform transform) {
  switch (transform) {
    case Transform::kNudge:
      return Moved(std::move(scenario), {.p_m = {1e-6, 0, 0}});
    case Transform::kShift:
      return Moved(std::move(scenario), {.p_m = {1e-3, 0, 0}});
    case Transform::kFar: {
      const double along_y_m = scenario.scene.world.planar ? 0 : 2;
      return Moved(std::move(scenario), {.p_m = {4, along_y_m, 0}});
    }
    case Transform::kTurn:
      if (const std::string why = WhyDirected(scenario); !why.empty()) return tl::unexpected(why);
      return Moved(std::move(scenario), {.q = physics::FromRollPitchYaw({0, 0, 37})});
    case Transform::kReorder:
    case Transform::kBystander:
      break;
  }
  if (!scenario.sensing.sensors.IsPerfect())
    return tl::unexpected<std::string>(
        "the noise of its sensors is drawn for each entity by its place in the list");
  return transform == Transform::kReorder ? Reordered(std::move(scenario))
                                          : WithBystander(std::move(scenario));
}

Scenario Moved(Scenario scenario, const Pose& X) {
  const Motion move{X};
  std::ranges::for_each(scenario.scene.bodies, move);
  std::ranges::for_each(scenario.scene.joints, move);
  std::ranges::for_each(scenario.scene.hands, move);
  std::ranges::for_each(scenario.scene.persons, move);
  for (physics::ScriptStage& stage : scenario.script.stages) {
    for (physics::Step& step : stage.steps) std::visit(move, step.action);
    for (physics::PersonStep& step : stage.person_steps) std::visit(move, step.action);
  }
  for (Outcome& outcome : scenario.outcomes) std::ranges::for_each(outcome.conditions, move);
  return scenario;
}

}  // namespace prehend::scenario

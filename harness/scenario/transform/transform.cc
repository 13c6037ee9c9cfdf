// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/transform/transform.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;

/// What is said of places in the world in the steps of a script.
struct ShiftStep {
  const Vector3d& by_m;
  void operator()(std::vector<physics::TimedPose>& poses) const {
    for (physics::TimedPose& pose : poses) pose.X_WH.p_m += by_m;
  }
  void operator()(physics::CarryStep& step) const { step.to_m += by_m.head<2>(); }
  void operator()(physics::PosesStep& step) const {
    for (std::size_t i = 0; i < step.poses.size(); ++i) {
      const physics::PoseFrame frame = step.frames.empty() ? physics::PoseFrame{} : step.frames[i];
      if (!frame.own_hand && frame.name.empty()) step.poses[i].X_WH.p_m += by_m;
    }
  }
  void operator()(physics::LookAtStep& step) const {
    if (auto* const point_m = std::get_if<Vector3d>(&step.target)) *point_m += by_m;
  }
  void operator()(physics::WalkStep& step) const { step.to_m += by_m.head<2>(); }
  void operator()(physics::MoveLimbStep& step) const {
    if (step.to_m) *step.to_m += by_m;
  }
  void operator()(physics::HeadPosesStep& step) const { (*this)(step.poses); }
  void operator()(physics::BodyPosesStep& step) const {
    for (physics::TimedPosture& timed : step.postures) timed.posture.hips_W_m += by_m;
  }
  /// They name no place.
  void operator()(const physics::OneOf<
                  physics::WaitStep, physics::ReachStep, physics::TriggerStep, physics::MoveStep,
                  physics::PlaceStep, physics::RetreatStep, physics::FollowJointStep,
                  physics::TurnHandStep, physics::OrbitStep, physics::PressStep, physics::EyesStep,
                  physics::TurnStep, physics::LeanStep, physics::SwayStep> auto&) const {}
};

/// `order[i]` is what becomes the i-th of `items`.
template <typename T>
std::vector<T> InOrder(const std::vector<T>& items, const std::vector<int>& order) {
  std::vector<T> ordered;
  for (const int index : order) ordered.push_back(items[static_cast<std::size_t>(index)]);
  return ordered;
}

/// All bodies the other way round, but those of persons, which are consecutive.
Scenario Reordered(Scenario scenario) {
  physics::Scene& scene = scenario.scene;
  std::vector<int> others;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (!scene.bodies[i].kinematic) others.push_back(static_cast<int>(i));
  std::vector<int> order(scene.bodies.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = 0; i < others.size(); ++i)
    order[static_cast<std::size_t>(others[i])] = others[others.size() - 1 - i];
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  const auto replaced = [&](int body) {
    return body < 0 ? body : place[static_cast<std::size_t>(body)];
  };
  const auto replace = [&](physics::BodyIndex& body) {
    body = physics::BodyIndex(replaced(body.number()));
  };
  scene.bodies = InOrder(scene.bodies, order);
  scenario.body_classes = InOrder(scenario.body_classes, order);
  scenario.body_part_of = InOrder(scenario.body_part_of, order);
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
  constexpr std::string_view kNames[] = {"nudge", "shift", "far", "reorder", "bystander"};
  return kNames[static_cast<std::size_t>(transform)];
}

tl::expected<Scenario, std::string> Transformed(Scenario scenario, Transform transform) {
  switch (transform) {
    case Transform::kNudge:
      return Shifted(std::move(scenario), {1e-6, 0, 0});
    case Transform::kShift:
      return Shifted(std::move(scenario), {1e-3, 0, 0});
    case Transform::kFar: {
      const double along_y_m = scenario.scene.world.planar ? 0 : 2;
      return Shifted(std::move(scenario), {4, along_y_m, 0});
    }
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

Scenario Shifted(Scenario scenario, const Vector3d& by_m) {
  for (physics::Body& body : scenario.scene.bodies) {
    body.X_WB.p_m += by_m;
    if (body.grains)
      for (Vector3d& p_WG_m : body.grains->p_WG_m) p_WG_m += by_m;
  }
  for (physics::Joint& joint : scenario.scene.joints) joint.pivot_W_m += by_m;
  for (physics::Hand& hand : scenario.scene.hands) hand.X_WH.p_m += by_m;
  for (physics::Person& person : scenario.scene.persons) person.X_WS.p_m += by_m;
  for (physics::ScriptStage& stage : scenario.script.stages) {
    for (physics::Step& step : stage.steps) std::visit(ShiftStep{by_m}, step.action);
    for (physics::PersonStep& step : stage.person_steps) std::visit(ShiftStep{by_m}, step.action);
  }
  for (Outcome& outcome : scenario.outcomes) {
    for (Outcome::Condition& condition : outcome.conditions) {
      if (!condition.wanted.near_m) continue;
      std::vector<double>& near_m = *condition.wanted.near_m;
      for (std::size_t i = 0; i < near_m.size(); ++i)
        near_m[i] += by_m[static_cast<Eigen::Index>(i)];
    }
  }
  return scenario;
}

}  // namespace prehend::scenario

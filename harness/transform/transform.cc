// SPDX-License-Identifier: Apache-2.0
// See harness/transform/transform.h. Tested by tests/harness/transform/transform_test.cc
#include "harness/transform/transform.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace prehend::harness {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using physics::Pose;

constexpr double kNudge_m = 1e-6, kShift_m = 1e-3, kTurn_deg = 37;

Vector3d InMirror(const Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

/// Of rotations, and of what turns about an axis.
Vector3d AxisInMirror(const Vector3d& v) { return -InMirror(v); }

Pose InMirror(const Pose& X) {
  const Vector3d axis = AxisInMirror(X.q.vec());
  return {InMirror(X.p_m), Eigen::Quaterniond(X.q.w(), axis.x(), axis.y(), axis.z())};
}

/// A motion of the whole world: first a mirror image, if any, then `X`.
struct WorldMotion {
  bool mirrors = false;
  Pose X;

  Vector3d Direction(const Vector3d& v) const { return X.q * (mirrors ? InMirror(v) : v); }
  Vector3d Axis(const Vector3d& v) const { return X.q * (mirrors ? AxisInMirror(v) : v); }
  Vector3d Point(const Vector3d& p) const { return X.p_m + Direction(p); }
  Pose Of(const Pose& X_WB) const { return X * (mirrors ? InMirror(X_WB) : X_WB); }
  /// In a body's own frame.
  Vector3d Own(const Vector3d& p) const { return mirrors ? InMirror(p) : p; }
  Vector2d Ground(const Vector2d& p) const { return Point({p.x(), p.y(), 0}).head<2>(); }
  double Yaw(double yaw_rad) const { return (mirrors ? -yaw_rad : yaw_rad) + Turn_rad(); }
  double Turn_rad() const { return 2 * std::atan2(X.q.z(), X.q.w()); }
};

void Move(const WorldMotion& motion, physics::Body& body) {
  body.X_WB = motion.Of(body.X_WB);
  if (body.grains)
    for (Vector3d& p_WG_m : body.grains->p_WG_m) p_WG_m = motion.Point(p_WG_m);
  if (!motion.mirrors) return;
  for (physics::PlacedShape& placed : body.shapes) {
    placed.X_BS = InMirror(placed.X_BS);
    auto* const hull = std::get_if<physics::Hull>(&placed.shape);
    if (!hull) continue;
    for (Vector3d& corner_m : hull->corners_m) corner_m = InMirror(corner_m);
    for (physics::Hull::Face& face : hull->faces) {
      std::ranges::reverse(face.corners);  // counter-clockwise again
      face.nhat_S = InMirror(face.nhat_S);
    }
    hull->X_SC = InMirror(hull->X_SC);
  }
}

void Move(const WorldMotion& motion, physics::Joint& joint) {
  joint.pivot_W_m = motion.Point(joint.pivot_W_m);
  const bool turns = joint.kind == physics::JointKind::kHinge;
  joint.axis_W = turns ? motion.Axis(joint.axis_W) : motion.Direction(joint.axis_W);
}

void Move(const WorldMotion& motion, std::vector<physics::TimedPose>& poses) {
  for (physics::TimedPose& pose : poses) pose.X_WH = motion.Of(pose.X_WH);
}

struct MoveStep {
  const WorldMotion& motion;
  void operator()(physics::ReachStep& step) const {
    step.offset_m = motion.Direction(step.offset_m);
    if (step.point_m) step.point_m = motion.Own(*step.point_m);
  }
  void operator()(physics::MoveStep& step) const { step.by_m = motion.Direction(step.by_m); }
  void operator()(physics::CarryStep& step) const { step.to_m = motion.Ground(step.to_m); }
  void operator()(physics::PosesStep& step) const { Move(motion, step.poses); }
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
  template <typename Other>  // says nothing about the world
  void operator()(Other&) const {}
};

Scenario Moved(Scenario scenario, const WorldMotion& motion) {
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
  return scenario;
}

Scenario Shifted(const Scenario& scenario, const Vector3d& by_m) {
  return Moved(scenario, {.X = {.p_m = by_m}});
}

bool IsDrawnInWorldAxes(const physics::TrackerSettings& tracking) {
  return tracking.jitter_mm > 0 || tracking.jitter_deg > 0 || tracking.tremor_mm > 0;
}

/// Why the scenario, turned or mirrored, is another story; "": it is not.
std::string WhyDirected(const Scenario& scenario) {
  if (scenario.scene.world.planar) return "it is planar";
  for (const physics::Hand& hand : scenario.scene.hands) {
    if (hand.tracking && IsDrawnInWorldAxes(*hand.tracking))
      return "the noise of its tracker is drawn along the axes of the world";
  }
  return {};
}

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
  const auto replace = [&](int& body) {
    if (body >= 0) body = place[static_cast<std::size_t>(body)];
  };
  scene.bodies = InOrder(scene.bodies, order);
  scenario.body_classes = InOrder(scenario.body_classes, order);
  scenario.body_part_of = InOrder(scenario.body_part_of, order);
  for (int& whole : scenario.body_part_of) replace(whole);
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
    body.shapes = {{.shape = physics::Box{size_m}, .X_BS = {}}};
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

const std::vector<TransformName>& TransformNames() {
  static const std::vector<TransformName> names = {
      {Transform::kNudge, "nudge", "everything 1 um along x, so that only rounding changes"},
      {Transform::kShift, "shift", "everything 1 mm along x"},
      {Transform::kFar, "far", "everything 4 m along x and 2 m along y"},
      {Transform::kTurn, "turn", "everything turned by 37 degrees about the vertical"},
      {Transform::kMirror, "mirror", "mirrored: right hands become left ones"},
      {Transform::kReorder, "reorder", "entities listed the other way round"},
      {Transform::kBystander, "bystander", "a box lies asleep on a slab, 14 m away"},
  };
  return names;
}

const std::vector<Transform>& EnsembleTransforms() {
  static const std::vector<Transform> transforms = {Transform::kNudge, Transform::kShift,
                                                    Transform::kFar, Transform::kReorder,
                                                    Transform::kBystander};
  return transforms;
}

std::string_view NameOf(Transform transform) {
  return std::ranges::find(TransformNames(), transform, &TransformName::transform)->name;
}

tl::expected<Scenario, std::string> Transformed(const Scenario& scenario, Transform transform) {
  const bool planar = scenario.scene.world.planar;
  const std::string directed = WhyDirected(scenario);
  switch (transform) {
    case Transform::kNudge:
      return Shifted(scenario, {kNudge_m, 0, 0});
    case Transform::kShift:
      return Shifted(scenario, {kShift_m, 0, 0});
    case Transform::kFar:
      return Shifted(scenario, {4, planar ? 0. : 2., 0});
    case Transform::kTurn:
      if (!directed.empty()) return tl::unexpected(directed);
      return Moved(scenario, {.X = {.q = physics::FromRollPitchYaw({0, 0, kTurn_deg})}});
    case Transform::kMirror:
      if (!directed.empty()) return tl::unexpected(directed);
      if (!scenario.scene.persons.empty())
        return tl::unexpected<std::string>("a person's right hand would be on the left");
      return Moved(scenario, {.mirrors = true, .X = {}});
    case Transform::kReorder:
      return Reordered(scenario);
    case Transform::kBystander:
      return WithBystander(scenario);
  }
  return tl::unexpected<std::string>("unknown");
}

}  // namespace prehend::harness

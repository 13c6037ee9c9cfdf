// SPDX-License-Identifier: Apache-2.0
// See harness/transform/transform.h. Tested by tests/harness/transform/transform_test.cc
#include "harness/transform/transform.h"

#include <algorithm>
#include <utility>

#include "harness/transform/change_entities.h"
#include "harness/transform/move_scenario.h"

namespace prehend::harness {
namespace {

using Refusal = tl::unexpected<std::string>;

constexpr double kNudge_m = 1e-6, kShift_m = 1e-3, kTurn_deg = 37;

Scenario Shifted(const Scenario& scenario, const Eigen::Vector3d& by_m) {
  return Moved(scenario, {.X = {.p_m = by_m}});
}

bool IsDrawnInWorldAxes(const physics::TrackerSettings& tracking) {
  return tracking.jitter_mm > 0 || tracking.jitter_deg > 0 || tracking.tremor_mm > 0;
}

/// Why the grammar would be shown other noise.
std::string WhyNoisy(const Scenario& scenario, std::string_view how) {
  return scenario.sensing.sensors.IsPerfect()
             ? std::string()
             : "the noise of its sensors is drawn " + std::string(how);
}

/// Why the scenario, turned or mirrored, is another story; "": it is not.
std::string WhyDirected(const Scenario& scenario) {
  if (scenario.scene.world.planar) return "it is planar";
  for (const physics::Hand& hand : scenario.scene.hands) {
    if (hand.tracking && IsDrawnInWorldAxes(*hand.tracking))
      return "the noise of its tracker is drawn along the axes of the world";
  }
  return WhyNoisy(scenario, "along the axes of the world");
}

/// Why a copy would not be alone; "": it is.
std::string WhyNoRoomForCopy(const Scenario& scenario) {
  for (const physics::Body& body : scenario.scene.bodies) {
    const physics::LocalBox box = physics::BoundingBox(body);
    if (body.abstract == physics::Abstract::kNot &&
        (body.X_WB * box.p_BC_m).norm() + box.half_size_m.norm() > kMostExtentBesideCopy_m)
      return body.name + " reaches too far for a copy beside it";
  }
  return {};
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
      {Transform::kRename, "rename", "other names, which the alphabet has the other way round"},
      {Transform::kCopies, "copies", "a second copy, 13 m away, does the same at the same time"},
      {Transform::kRate, "rate", "rate_hz doubled: physics in steps half as long"},
      {Transform::kWatch, "watch", "sensing_hz doubled, at most rate_hz: the grammar sees more"},
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

namespace {

tl::expected<Scenario, std::string> Changed(const Scenario& scenario, Transform transform) {
  const physics::WorldSettings& world = scenario.scene.world;
  const std::string directed = WhyDirected(scenario);
  const std::string listed = WhyNoisy(scenario, "for each entity by its place in the list");
  Scenario changed = scenario;
  switch (transform) {
    case Transform::kNudge:
      return Shifted(scenario, {kNudge_m, 0, 0});
    case Transform::kShift:
      return Shifted(scenario, {kShift_m, 0, 0});
    case Transform::kFar:
      return Shifted(scenario, {4, world.planar ? 0. : 2., 0});
    case Transform::kTurn:
      if (!directed.empty()) return Refusal(directed);
      return Moved(scenario, {.X = {.q = physics::FromRollPitchYaw({0, 0, kTurn_deg})}});
    case Transform::kMirror:
      if (!directed.empty()) return Refusal(directed);
      if (!scenario.scene.persons.empty())
        return Refusal("a person's right hand would be on the left");
      return Moved(scenario, {.mirrors = true, .X = {}});
    case Transform::kReorder:
      if (!listed.empty()) return Refusal(listed);
      return Reordered(scenario);
    case Transform::kBystander:
      if (!listed.empty()) return Refusal(listed);
      return WithBystander(scenario);
    case Transform::kRename:
      return Renamed(scenario, NamesTurnedRound(scenario));
    case Transform::kCopies:
      if (!listed.empty()) return Refusal(listed);
      if (const std::string why = WhyNoRoomForCopy(scenario); !why.empty()) return Refusal(why);
      return WithCopy(scenario);
    case Transform::kRate:
      changed.scene.world.rate_hz *= 2;
      return changed;
    case Transform::kWatch:
      if (scenario.sensing.sensing_hz == world.rate_hz)
        return Refusal("the grammar sees every tick already");
      changed.sensing.sensing_hz = std::min(2 * scenario.sensing.sensing_hz, world.rate_hz);
      return changed;
  }
  return Refusal("unknown");
}

}  // namespace

tl::expected<TransformedScenario, std::string> Transformed(const Scenario& scenario,
                                                           Transform transform) {
  auto changed = Changed(scenario, transform);
  if (!changed) return Refusal(changed.error());
  TransformedScenario there{.scenario = std::move(*changed), .names = {}};
  for (const auto& [written, turned_round] : NamesTurnedRound(scenario))
    there.names[transform == Transform::kRename ? turned_round : written] = written;
  return there;
}

}  // namespace prehend::harness

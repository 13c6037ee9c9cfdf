// SPDX-License-Identifier: Apache-2.0
#include "harness/show/pictures/regions_of_interest.h"

#include <algorithm>
#include <optional>
#include <set>

#include "harness/episode/run/event_time.h"
#include "harness/show/pictures/scenery.h"
#include "physics/scene/geometry.h"

namespace prehend::show {
namespace {

using Eigen::Vector3d;
using grammar::RegionOfInterest;
using Middle = RegionOfInterest::Middle;

constexpr double kStar_m = 0.022, kStarAbove_m = 0.035;

int HandNamed(const physics::Scene& scene, const std::string& name) {
  const auto hand = std::ranges::find(scene.hands, name, &physics::Hand::name);
  return hand == scene.hands.end() ? -1 : static_cast<int>(hand - scene.hands.begin());
}

std::optional<Vector3d> MiddleOf(const RegionOfInterest& region, const physics::Scene& scene,
                                 const episode::RunResult& run, const grammar::NamedEvent& event,
                                 const physics::Snapshot& now) {
  const std::string& name = event.roles[static_cast<std::size_t>(region.role)].value;
  const physics::Snapshot& at =
      region.middle == Middle::kAtBegin ? episode::SnapshotAt(run, event.interval.begin)
      : region.middle == Middle::kAtEnd ? episode::SnapshotAt(run, event.interval.end)
                                        : now;
  if (const int hand = HandNamed(scene, name); hand >= 0) {
    const auto index = static_cast<std::size_t>(hand);
    const physics::Pose& X_WH = at.hands[index].palm.X_WB;
    if (region.middle != Middle::kAhead) return X_WH.p_m;
    return X_WH * (region.ahead_m * scene.hands[index].model.ahead);
  }
  const physics::BodyIndex body = physics::FindBody(scene, name);
  if (body == physics::kNone || region.middle == Middle::kAhead) return std::nullopt;
  return at.body(body).X_WB.p_m;
}

/// A star above each thing that can be moved and is in the sphere.
void MarkCandidates(const physics::Scene& scene, const physics::Snapshot& now,
                    const Vector3d& middle_m, double radius_m, std::set<physics::BodyIndex>& marked,
                    std::vector<render::Marker>& markers) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const physics::BodyIndex body(i);
    const physics::Pose& X_WB = now.bodies[i].X_WB;
    if (scene.bodies[i].shapes.empty() || !physics::MovesFreely(scene, body)) continue;
    if (physics::DistanceTo(scene.bodies[i], X_WB.inverse() * middle_m) > radius_m) continue;
    if (!marked.insert(body).second) continue;
    const Eigen::AlignedBox3d bounds = physics::WorldBounds(scene.bodies[i], X_WB);
    const Vector3d above(bounds.center().x(), bounds.center().y(), bounds.max().z() + kStarAbove_m);
    markers.push_back({.kind = render::MarkerKind::kCandidate,
                       .p_W_m = above.cast<float>(),
                       .half_size_m = Eigen::Vector3f::Constant(kStar_m)});
  }
}

}  // namespace

std::vector<render::Marker> RegionMarkers(
    const scenario::Scenario& scenario, const episode::RunResult& run, const physics::Snapshot& now,
    const std::function<bool(const grammar::NamedEvent&)>& shown) {
  const physics::Scene& scene = scenario.scene;
  std::vector<render::Marker> markers;
  std::set<physics::BodyIndex> candidates;
  for (const grammar::NamedEvent& event : run.timeline.events) {
    const truth::EventDrawing& drawing = run.drawings.Of(event.event);
    const bool is_now = event.interval.begin <= now.tick && now.tick < event.interval.end;
    if (drawing.as != grammar::DrawnAs::kPhase || !is_now || !shown(event)) continue;
    for (const RegionOfInterest& region : drawing.regions) {
      const std::optional<Vector3d> middle_m = MiddleOf(region, scene, run, event, now);
      if (!middle_m) continue;
      const bool is_sphere = region.shape == RegionOfInterest::Shape::kSphere;
      const double height_m = is_sphere ? region.radius_m : region.height_m;
      markers.push_back(
          {.kind = is_sphere ? render::MarkerKind::kSphere : render::MarkerKind::kCylinder,
           .p_W_m = middle_m->cast<float>(),
           .half_size_m = Vector3d(region.radius_m, region.radius_m, height_m).cast<float>(),
           .color = ColorOf(drawing.color)});
      if (region.middle == Middle::kAhead)
        MarkCandidates(scene, now, *middle_m, region.radius_m, candidates, markers);
    }
  }
  return markers;
}

}  // namespace prehend::show

// SPDX-License-Identifier: Apache-2.0
#include "harness/show/pictures/scenery.h"

#include <algorithm>
#include <array>
#include <set>

#include "physics/scene/geometry.h"

namespace prehend::show {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kWood = 0xC8A27C, kPerson = 0xC6BCB0, kSkin = 0xE0AC86;
constexpr std::uint32_t kRegionRgb = 0x6BA8FF, kGazeTargetRgb = 0xF273BF;
/// A thing that is narrower stands on one leg, or on two.
constexpr double kFourLegsFrom_m = 0.25;
/// A thin board this near to the floor lies on it.
constexpr double kBoardThick_m = 0.12, kBoardLies_m = 0.10;
/// Nearer than this to what is below, a thing stands on it.
constexpr double kStands_m = 0.02;
/// A lower gap is filled by a plinth.
constexpr double kPlinth_m = 0.12;
constexpr double kLegHalf_m = 0.02;
/// Cosine of the tilt up to which a thing has legs below its corners.
constexpr double kUpright = 0.9;
constexpr double kGazeEnds_m = 1.5;  ///< length of a ray that meets nothing
constexpr float kHidingAlpha = 0.35f;
constexpr double kAroundHand_m = 0.10;
constexpr double kMoves_m_per_s = 0.02;

/// Fixed things are wood and persons are a mannequin's; others differ from their neighbours.
std::uint32_t PaletteColor(const physics::Body& body, std::size_t index) {
  using enum physics::Abstract;
  if (body.abstract == kRegion) return kRegionRgb;
  if (body.abstract == kGazeTarget) return kGazeTargetRgb;
  if (body.fixed) return kWood;
  if (body.kinematic) return kPerson;
  constexpr std::array<std::uint32_t, 6> palette = {0xE9EEF2, 0xE07A3F, 0x3F6E8C,
                                                    0xB23A48, 0x8FB339, 0x8C6BB1};
  return palette[index % palette.size()];
}

Eigen::AlignedBox3d PlacedBounds(const physics::Scene& scene, const physics::Snapshot& now,
                                 std::size_t body) {
  const physics::LocalBox box = physics::BoundingBox(scene.bodies[body]);
  const physics::Pose& X_WB = now.bodies[body].X_WB;
  const Vector3d half = X_WB.q.toRotationMatrix().cwiseAbs() * box.half_size_m;
  const Vector3d centre = X_WB * box.p_BC_m;
  return {centre - half, centre + half};
}

bool IsFurniture(const physics::Body& body) {
  return body.fixed && physics::IsThing(body) && !body.shapes.empty();
}

/// Whether another fixed thing bears it: from below, or beside it or around it.
bool IsBorne(const scenario::Scenario& scenario, const physics::Snapshot& now, std::size_t thing,
             const Eigen::AlignedBox3d& bounds) {
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    if (i == thing || !IsFurniture(scenario.scene.bodies[i])) continue;
    Eigen::AlignedBox3d other = PlacedBounds(scenario.scene, now, i);
    const bool is_lower = other.min().z() < bounds.min().z() - 0.01;
    other.min().array() -= kStands_m;
    other.max().array() += kStands_m;
    if (is_lower && other.intersects(bounds)) return true;
  }
  return false;
}

/// The height of the highest fixed thing below a point, or of the floor.
double GroundBelow_m(const scenario::Scenario& scenario, const physics::Snapshot& now,
                     const Vector3d& p_W_m) {
  double ground_m = 0;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    if (!IsFurniture(scenario.scene.bodies[i])) continue;
    const Eigen::AlignedBox3d other = PlacedBounds(scenario.scene, now, i);
    const bool is_above_it = (other.min().head<2>().array() < p_W_m.head<2>().array()).all() &&
                             (p_W_m.head<2>().array() < other.max().head<2>().array()).all();
    if (is_above_it && other.max().z() < p_W_m.z()) ground_m = std::max(ground_m, other.max().z());
  }
  return ground_m;
}

/// Where the legs of a thing begin, in its own frame, and half their thickness.
struct Feet {
  std::vector<Vector3d> tops_m;
  Eigen::Vector2d half_m;
};

/// Below its corners, its ends or its middle, as it is wide, long or small.
Feet FeetOf(const physics::LocalBox& box) {
  Feet feet{.half_m = Eigen::Vector2d::Constant(kLegHalf_m)};
  std::array<std::vector<double>, 2> places;
  for (int axis = 0; axis < 2; ++axis) {
    const double half = box.half_size_m[axis];
    feet.half_m[axis] = std::min(kLegHalf_m, half);
    if (2 * half >= kFourLegsFrom_m)
      places[axis] = {-half + 2 * kLegHalf_m, half - 2 * kLegHalf_m};
    else
      places[axis] = {0};
  }
  for (const double x : places[0]) {
    for (const double y : places[1])
      feet.tops_m.push_back(box.p_BC_m + Vector3d(x, y, -box.half_size_m.z()));
  }
  return feet;
}

/// Hands, what they and persons touch, and what else moves.
std::vector<Vector3d> PlacesOfAction(const physics::Scene& scene, const physics::Snapshot& now) {
  std::vector<Vector3d> places_m;
  for (const physics::HandState& hand : now.hands) places_m.push_back(hand.palm.X_WB.p_m);
  const auto acts = [&](const physics::ContactSide& side) {
    return side.hand != physics::kNone || scene.body(side.body).kinematic;
  };
  std::vector<bool> is_acted_on(scene.bodies.size());
  for (const physics::ContactPoint& contact : now.contacts) {
    if (contact.a.body != physics::kNone && acts(contact.b))
      is_acted_on[contact.a.body.index()] = true;
    if (contact.b.body != physics::kNone && acts(contact.a))
      is_acted_on[contact.b.body.index()] = true;
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const physics::Body& body = scene.bodies[i];
    if (body.fixed || body.shapes.empty() || !physics::IsThing(body) || body.kinematic) continue;
    if (is_acted_on[i] || now.bodies[i].v_WB_m_per_s.norm() > kMoves_m_per_s)
      places_m.push_back(now.bodies[i].X_WB * physics::BoundingBox(body).p_BC_m);
  }
  return places_m;
}

/// Whether the box, a little larger, is on the way from the eye to just before the place.
bool IsBetween(const physics::LocalBox& box, const physics::Pose& X_WB, const Vector3d& eye_m,
               const Vector3d& place_m) {
  const Vector3d to = place_m - eye_m;
  const Vector3d end = eye_m + to * std::max(0.0, 1 - kAroundHand_m * 2 / to.norm());
  const physics::Pose X_BW = X_WB.inverse();
  const Vector3d a = X_BW * eye_m - box.p_BC_m, b = X_BW * end - box.p_BC_m;
  const Vector3d half = box.half_size_m.array() + kAroundHand_m;
  double first = 0, last = 1;
  for (int k = 0; k < 3; ++k) {
    const double d = b[k] - a[k];
    if (std::abs(d) < 1e-12) {
      if (std::abs(a[k]) > half[k]) return false;
      continue;
    }
    const double t0 = (-half[k] - a[k]) / d, t1 = (half[k] - a[k]) / d;
    first = std::max(first, std::min(t0, t1));
    last = std::min(last, std::max(t0, t1));
  }
  return first <= last;
}

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

render::Color ColorOf(std::uint32_t rgb) {
  return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255,
          static_cast<float>(rgb & 255) / 255};
}

bool IsSeen(const physics::Body& body) {
  return body.abstract != physics::Abstract::kCamera && body.abstract != physics::Abstract::kLight;
}

std::vector<render::Color> BodyColors(const scenario::Scenario& scenario) {
  std::vector<render::Color> colors;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    std::optional<std::uint32_t> rgb;
    if (const auto said = scenario.colors.find(body.name); said != scenario.colors.end())
      rgb = said->second;
    const bool is_thing = body.abstract == physics::Abstract::kNot && !body.kinematic;
    if (!rgb && is_thing) rgb = scenario::ColorInName(body.name);
    if (!rgb && is_thing) rgb = scenario::ColorOfClass(scenario.body_classes[i]);
    colors.push_back(ColorOf(rgb.value_or(PaletteColor(body, i))));
  }
  return colors;
}

std::vector<std::vector<render::Color>> SensorColors(
    const physics::Scene& scene, const std::map<std::string, std::uint32_t>& color_of_set) {
  if (color_of_set.empty()) return {};
  std::vector<std::vector<render::Color>> colors;
  for (const physics::Hand& hand : scene.hands) {
    const auto color_of = [&](int set) {
      const bool is_set = set >= 0 && set < static_cast<int>(hand.model.sensor_sets.size());
      const auto color =
          is_set ? color_of_set.find(hand.model.sensor_sets[static_cast<std::size_t>(set)])
                 : color_of_set.end();
      return color == color_of_set.end() ? ColorOf(kSkin) : ColorOf(color->second);
    };
    std::vector<render::Color> parts = {color_of(hand.model.palm_sensor_set)};
    for (const physics::HandLink& link : hand.model.links)
      parts.push_back(color_of(link.sensor_set));
    colors.push_back(std::move(parts));
  }
  return colors;
}

std::vector<render::Prop> LegsOf(const scenario::Scenario& scenario,
                                 const std::vector<render::Color>& colors,
                                 const physics::Snapshot& now) {
  std::vector<render::Prop> legs;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    if (!IsFurniture(body)) continue;
    const Eigen::AlignedBox3d bounds = PlacedBounds(scenario.scene, now, i);
    if (IsBorne(scenario, now, i, bounds)) continue;
    const Vector3d middle(bounds.center().x(), bounds.center().y(), bounds.min().z());
    const double gap_m = middle.z() - GroundBelow_m(scenario, now, middle);
    const bool lies = bounds.sizes().z() <= kBoardThick_m && gap_m <= kBoardLies_m;
    if (gap_m <= kStands_m || lies) continue;
    const auto add = [&](const Vector3d& top_W_m, const Eigen::Vector2d& half_m) {
      const double ground_m = GroundBelow_m(scenario, now, top_W_m);
      legs.push_back(
          {.name = "leg:" + body.name,
           .center_m =
               Vector3d(top_W_m.x(), top_W_m.y(), (top_W_m.z() + ground_m) / 2).cast<float>(),
           .half_size_m =
               Vector3d(half_m.x(), half_m.y(), (top_W_m.z() - ground_m) / 2).cast<float>(),
           .color = 0.8f * colors[i]});
    };
    const Eigen::Vector2d half_m = bounds.sizes().head<2>() / 2;
    const physics::Pose& X_WB = now.bodies[i].X_WB;
    if (gap_m < kPlinth_m) {
      add(middle, (half_m.array() - kLegHalf_m).max(half_m.array() / 2));
    } else if (X_WB.q.toRotationMatrix()(2, 2) < kUpright) {
      add(middle, half_m.array().min(kLegHalf_m));
    } else {
      const Feet feet = FeetOf(physics::BoundingBox(body));
      for (const Vector3d& top_m : feet.tops_m) add(X_WB * top_m, feet.half_m);
    }
  }
  return legs;
}

std::vector<render::GazeRay> GazesOf(const physics::Scene& scene, const physics::Snapshot& now) {
  std::vector<render::GazeRay> rays;
  for (std::size_t i = 0; i < std::min(scene.persons.size(), now.gazes.size()); ++i) {
    const physics::GazeState& gaze = now.gazes[i];
    const bool hits = gaze.body != physics::kNone || gaze.hand != physics::kNone;
    const double length_m = hits ? gaze.distance_m : kGazeEnds_m;
    rays.push_back({.from_m = gaze.p_WE_m.cast<float>(),
                    .to_m = (gaze.p_WE_m + length_m * gaze.toward_W).cast<float>(),
                    .hits = hits});
  }
  return rays;
}

std::vector<float> BodyAlphas(const physics::Scene& scene, const physics::Snapshot& now,
                              const Eigen::Vector3f& eye_m) {
  std::vector<float> alphas(scene.bodies.size(), 1);
  const std::vector<Vector3d> action = PlacesOfAction(scene, now);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].kinematic || scene.bodies[i].shapes.empty()) continue;
    const physics::LocalBox box = physics::BoundingBox(scene.bodies[i]);
    const bool hides = std::ranges::any_of(action, [&](const Vector3d& place_m) {
      return IsBetween(box, now.bodies[i].X_WB, eye_m.cast<double>(), place_m);
    });
    if (hides) alphas[i] = kHidingAlpha;
  }
  return alphas;
}

std::optional<Eigen::Vector3f> ToLight(const physics::Scene& scene) {
  const auto light =
      std::ranges::find(scene.bodies, physics::Abstract::kLight, &physics::Body::abstract);
  if (light == scene.bodies.end()) return std::nullopt;
  Eigen::AlignedBox3d things;
  for (const physics::Body& body : scene.bodies)
    if (physics::IsThing(body)) things.extend(body.X_WB.p_m);
  if (things.isEmpty()) return std::nullopt;
  return (light->X_WB.p_m - things.center()).cast<float>();
}

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

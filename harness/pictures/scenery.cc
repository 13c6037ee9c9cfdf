// SPDX-License-Identifier: Apache-2.0
#include "harness/pictures/scenery.h"

#include <algorithm>
#include <array>

#include "harness/scenario/colors.h"

namespace prehend::harness {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kWood = 0xC8A27C, kPerson = 0xC6BCB0, kSkin = 0xE0AC86;
constexpr std::uint32_t kRegionRgb = 0x6BA8FF, kGazeTargetRgb = 0xF273BF;
/// A board is at most this thick, and at least this long and wide.
constexpr double kBoardThick_m = 0.12, kBoardWide_m = 0.25;
/// Lower boards lie on the floor.
constexpr double kLegFrom_m = 0.10;
constexpr double kLegHalf_m = 0.02;
constexpr double kGazeEnds_m = 1.5;  ///< length of a ray that meets nothing
constexpr float kHidingAlpha = 0.35f;
constexpr double kAroundHand_m = 0.10;

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

bool IsBoard(const Eigen::AlignedBox3d& bounds) {
  const Vector3d size = bounds.sizes();
  return size.z() <= kBoardThick_m && size.head<2>().minCoeff() >= kBoardWide_m &&
         bounds.min().z() > kLegFrom_m;
}

/// Whether some other thing stands below the board.
bool IsCarried(const Scenario& scenario, const physics::Snapshot& now, std::size_t board,
               const Eigen::AlignedBox3d& bounds) {
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& other = scenario.scene.bodies[i];
    if (i == board || !physics::IsThing(other) || other.shapes.empty()) continue;
    const Eigen::AlignedBox3d below = PlacedBounds(scenario.scene, now, i);
    const bool overlaps = (below.min().head<2>().array() < bounds.max().head<2>().array()).all() &&
                          (bounds.min().head<2>().array() < below.max().head<2>().array()).all();
    if (overlaps && below.min().z() < bounds.min().z() - 0.01) return true;
  }
  return false;
}

}  // namespace

render::Color ColorOf(std::uint32_t rgb) {
  return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255,
          static_cast<float>(rgb & 255) / 255};
}

bool IsSeen(const physics::Body& body) {
  return body.abstract != physics::Abstract::kCamera && body.abstract != physics::Abstract::kLight;
}

std::vector<render::Color> BodyColors(const Scenario& scenario) {
  std::vector<render::Color> colors;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    std::optional<std::uint32_t> rgb;
    if (const auto said = scenario.colors.find(body.name); said != scenario.colors.end())
      rgb = said->second;
    const bool is_thing = body.abstract == physics::Abstract::kNot && !body.kinematic;
    if (!rgb && is_thing) rgb = ColorInName(body.name);
    if (!rgb && is_thing) rgb = ColorOfClass(scenario.body_classes[i]);
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

std::vector<render::Prop> LegsOf(const Scenario& scenario, const std::vector<render::Color>& colors,
                                 const physics::Snapshot& now) {
  std::vector<render::Prop> legs;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    if (!body.fixed || !physics::IsThing(body) || body.shapes.empty()) continue;
    const Eigen::AlignedBox3d bounds = PlacedBounds(scenario.scene, now, i);
    if (!IsBoard(bounds) || IsCarried(scenario, now, i, bounds)) continue;
    const physics::LocalBox box = physics::BoundingBox(body);
    const physics::Pose& X_WB = now.bodies[i].X_WB;
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        const Vector3d corner(x * (box.half_size_m.x() - 2 * kLegHalf_m),
                              y * (box.half_size_m.y() - 2 * kLegHalf_m), -box.half_size_m.z());
        const Vector3d top = X_WB * (box.p_BC_m + corner);
        legs.push_back({.name = "leg:" + body.name,
                        .center_m = Vector3d(top.x(), top.y(), top.z() / 2).cast<float>(),
                        .half_size_m = Vector3d(kLegHalf_m, kLegHalf_m, top.z() / 2).cast<float>(),
                        .color = 0.8f * colors[i]});
      }
    }
  }
  return legs;
}

std::vector<render::GazeRay> GazesOf(const physics::Scene& scene, const physics::Snapshot& now) {
  std::vector<render::GazeRay> rays;
  for (std::size_t i = 0; i < std::min(scene.persons.size(), now.gazes.size()); ++i) {
    const physics::GazeState& gaze = now.gazes[i];
    const bool hits = gaze.body >= 0 || gaze.hand >= 0;
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
  const Vector3d eye = eye_m.cast<double>();
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!scene.bodies[i].kinematic || scene.bodies[i].shapes.empty()) continue;
    const physics::LocalBox box = physics::BoundingBox(scene.bodies[i]);
    const physics::Pose X_BW = now.bodies[i].X_WB.inverse();
    for (const physics::HandState& hand : now.hands) {
      // The segment from the eye to just before the hand, against the grown box of the part.
      const Vector3d to = hand.palm.X_WB.p_m - eye;
      const Vector3d end = eye + to * std::max(0.0, 1 - kAroundHand_m * 2 / to.norm());
      const Vector3d a = X_BW * eye - box.p_BC_m, b = X_BW * end - box.p_BC_m;
      const Vector3d half = box.half_size_m.array() + kAroundHand_m;
      double first = 0, last = 1;
      for (int k = 0; k < 3; ++k) {
        const double d = b[k] - a[k];
        if (std::abs(d) < 1e-12) {
          if (std::abs(a[k]) > half[k]) last = -1;
          continue;
        }
        const double t0 = (-half[k] - a[k]) / d, t1 = (half[k] - a[k]) / d;
        first = std::max(first, std::min(t0, t1));
        last = std::min(last, std::max(t0, t1));
      }
      if (first <= last) alphas[i] = kHidingAlpha;
    }
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

}  // namespace prehend::harness

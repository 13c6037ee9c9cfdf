// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/doubts/rest_poses.h.
//
// Places of rest are at least 5 cm apart. Things stand: each place is half the thing's height above
// the plane. That depends on which way is up, so the plane is fitted several times. What lies
// elsewhere, in a hand or on a shelf, is left out one after the other, the farthest first.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/exchange/doubts/motion_seen.h"
#include "harness/exchange/doubts/rest_poses.h"

namespace prehend::exchange {
namespace {

constexpr double kApart_m = 0.05;   ///< of two places
constexpr double kOff_m = 0.02;     ///< what is farther from the plane does not lie on it
constexpr double kLevel_m = 0.015;  ///< between places of one level
constexpr double kWide_m = 0.08;    ///< standard deviation of the places, across both ways
constexpr double kTilt_deg = 5;
constexpr double kMostShare = 0.5;  ///< of all places at least so many must lie on it
constexpr std::size_t kLeastPlaces = 5, kLeastThings = 3, kMostPlaces = 300;
constexpr int kRounds = 8;

struct RestPoint {
  Eigen::Vector3d p_m;
  double half_height_m = 0;
  std::size_t thing = 0;
};

struct RestPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< upwards
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double off_m = 0;    ///< root mean square of the distances
  double width_m = 0;  ///< of the places on it, along their shorter way
};

/// Of all entities at once: `places` of things, `hands` wherever they are.
struct SeenRestPoses {
  std::vector<RestPoint> places;
  std::vector<Eigen::Vector3d> hands;
};

SeenRestPoses RestPosesIn(const episode::Recording& episode, const std::set<std::size_t>& untrue) {
  SeenRestPoses seen;
  const auto& entities = episode.header.entity_table.entities;
  EachLook(episode, [&](const episode::EpisodeFrame& last, const episode::EpisodeFrame& frame) {
    for (std::size_t i = 0; i < entities.size(); ++i) {
      const grammar::EntitySample &look = frame.entities[i], &old = last.entities[i];
      if (!grammar::IsTracked(look) || !grammar::IsTracked(old)) continue;
      if (entities[i].classes.front() == "Hand") seen.hands.push_back(look.p_WB_m);
      if (untrue.contains(i) ||
          std::ranges::find(entities[i].classes, "Movable") == entities[i].classes.end() ||
          (look.p_WB_m - old.p_WB_m).norm() >= kSamePlace_m || seen.places.size() >= kMostPlaces)
        continue;
      const bool is_known = std::ranges::any_of(seen.places, [&](const RestPoint& place) {
        return place.thing == i && (place.p_m - look.p_WB_m).norm() < kApart_m;
      });
      if (!is_known) seen.places.push_back({look.p_WB_m, entities[i].half_size_m.z(), i});
    }
  });
  return seen;
}

/// Of the bottoms of things that stand as `up` says; hands are above it.
RestPlane FitPlane(const SeenRestPoses& seen, const Eigen::Vector3d& up) {
  RestPlane plane;
  const auto count = static_cast<double>(seen.places.size());
  std::vector<Eigen::Vector3d> bottoms;
  for (const RestPoint& place : seen.places)
    bottoms.emplace_back(place.p_m - place.half_height_m * up);
  for (const Eigen::Vector3d& bottom : bottoms) plane.middle += bottom / count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& bottom : bottoms)
    spread += (bottom - plane.middle) * (bottom - plane.middle).transpose() / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  plane.normal = axes.eigenvectors().col(0);
  plane.off_m = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
  plane.width_m = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  std::vector<double> heights;
  for (const Eigen::Vector3d& hand : seen.hands)
    heights.push_back(plane.normal.dot(hand - plane.middle));
  const double above = heights.empty() ? plane.normal.dot(up) : Median(std::move(heights));
  if (above < 0) plane.normal = -plane.normal;
  return plane;
}

RestPlane FitPlaneUpright(const SeenRestPoses& seen, Eigen::Vector3d up) {
  RestPlane plane;
  for (int round = 0; round < kRounds; ++round) {
    plane = FitPlane(seen, up);
    up = plane.normal;
  }
  return plane;
}

double OffPlane(const RestPlane& plane, const RestPoint& place) {
  return std::abs(plane.normal.dot(place.p_m - plane.middle) - place.half_height_m);
}

/// As the frame is, most things stand on one or two levels, or on what the map places.
bool IsLevel(const SeenRestPoses& seen, const ImportMap& map) {
  std::vector<double> tops, bottoms;
  for (const Named<MappedEntity>& entity : map.entities)
    if (entity.value.at_m) tops.push_back(entity.value.at_m->z() + entity.value.size_m.z() / 2);
  std::size_t on_tops = 0;
  for (const RestPoint& place : seen.places) {
    const double bottom = place.p_m.z() - place.half_height_m;
    bottoms.push_back(bottom);
    on_tops +=
        std::ranges::any_of(tops, [&](double top) { return std::abs(bottom - top) < kOff_m; });
  }
  const auto most =
      static_cast<std::ptrdiff_t>(std::ceil(kMostShare * static_cast<double>(seen.places.size())));
  if (static_cast<std::ptrdiff_t>(on_tops) >= most) return true;
  // Each level has two places or more.
  std::ptrdiff_t on_levels = 0;
  std::ranges::sort(bottoms);
  int levels = 0;
  for (auto begin = bottoms.begin(); begin != bottoms.end();) {
    const auto end = std::upper_bound(begin, bottoms.end(), *begin + kLevel_m);
    if (end - begin >= 2 && ++levels <= 2) on_levels += end - begin;
    begin = end;
  }
  return on_levels >=
         std::max<std::ptrdiff_t>(most, static_cast<std::ptrdiff_t>(bottoms.size()) - 1);
}

}  // namespace

std::string TiltOfRestPlane(const episode::Recording& episode, const ImportMap& map,
                            const std::set<std::size_t>& untrue) {
  SeenRestPoses seen = RestPosesIn(episode, untrue);
  if (IsLevel(seen, map)) return "";
  const std::size_t all = seen.places.size();
  RestPlane plane;
  while (true) {
    std::set<std::size_t> things;
    for (const RestPoint& place : seen.places) things.insert(place.thing);
    if (seen.places.size() < kLeastPlaces || things.size() < kLeastThings ||
        static_cast<double>(seen.places.size()) < kMostShare * static_cast<double>(all))
      return "";
    plane = FitPlaneUpright(seen, plane.normal);
    const auto off = [&](const RestPoint& place) { return OffPlane(plane, place); };
    const auto worst = std::ranges::max_element(seen.places, {}, off);
    if (off(*worst) > kOff_m) {
      seen.places.erase(worst);
      continue;
    }
    if (plane.width_m < kWide_m) return "";
    const double degrees = std::acos(std::clamp(plane.normal.z(), -1.0, 1.0)) * 180 / EIGEN_PI;
    if (degrees <= kTilt_deg) return "";
    const Eigen::Vector3d up = map.Mirrored(map.WorldTurn().conjugate() * plane.normal);
    const auto number = [](double x) { return std::round(1000 * x) / 1000 + 0.0; };
    return fmt::format(
        "things rest on a plane that is tilted by {:.1f} degrees: {} of {} places of rest, of {} "
        "things, are {:.1f} mm off it (root mean square); in the map: up: [{:g}, {:g}, {:g}]; or, "
        "if they stand at several heights, what they stand on",
        degrees, seen.places.size(), all, things.size(), 1e3 * plane.off_m, number(up.x()),
        number(up.y()), number(up.z()));
  }
}

}  // namespace prehend::exchange

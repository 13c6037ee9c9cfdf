// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/scenario/own_camera.h"

#include <charconv>
#include <cmath>

namespace prehend::scenario {
namespace {

constexpr double kFarthest_m = 100, kNearest_m = 0.01;
constexpr double kNarrowest_deg = 5, kWidest_deg = 120;

/// Reads a number and what has to follow it; false if there is something else.
bool Take(const char*& at, const char* end, double& value) {
  const auto [stop, error] = std::from_chars(at, end, value);
  at = stop;
  return error == std::errc() && std::isfinite(value);
}

bool Take(const char*& at, const char* end, char wanted) { return at != end && *at++ == wanted; }

bool Take(const char*& at, const char* end, Eigen::Vector3d& place_m) {
  return Take(at, end, place_m.x()) && Take(at, end, ',') && Take(at, end, place_m.y()) &&
         Take(at, end, ',') && Take(at, end, place_m.z()) &&
         place_m.cwiseAbs().maxCoeff() <= kFarthest_m;
}

}  // namespace

std::optional<OwnCamera> ParseOwnCamera(const std::string& text) {
  OwnCamera camera;
  const char* at = text.data();
  const char* const end = at + text.size();
  if (!Take(at, end, camera.eye_m) || !Take(at, end, ':') || !Take(at, end, camera.look_at_m))
    return std::nullopt;
  if (at != end && (!Take(at, end, ':') || !Take(at, end, camera.view_deg))) return std::nullopt;
  const bool is_view = camera.view_deg >= kNarrowest_deg && camera.view_deg <= kWidest_deg &&
                       (camera.eye_m - camera.look_at_m).norm() >= kNearest_m;
  return at == end && is_view ? std::optional(camera) : std::nullopt;
}

}  // namespace prehend::scenario

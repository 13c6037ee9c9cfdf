// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/scenario/scenario_test.cc and
// tests/harness/scenario/read/read_scenario_test.cc
#include "harness/scenario/scenario/scenario.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/scenario/scenario/own_camera.h"

namespace prehend::scenario {

Scenario::Scenario() = default;
Scenario::Scenario(const Scenario& other) = default;
Scenario::Scenario(Scenario&& other) noexcept = default;
Scenario& Scenario::operator=(const Scenario& other) = default;
Scenario& Scenario::operator=(Scenario&& other) noexcept = default;
Scenario::~Scenario() = default;

grammar::Tick DefaultTolerance(const Scenario& scenario) {
  const int rate_hz = scenario.scene.world.rate_hz;
  const int sensing_hz = scenario.sensing.sensing_hz;
  const grammar::Tick ticks_per_frame = (rate_hz + sensing_hz - 1) / sensing_hz;
  return 2 * ticks_per_frame;
}

const std::vector<std::string>& CameraWords() {
  static const std::vector<std::string> words = {"front",         "left", "right",  "top",
                                                 "three_quarter", "hand", "action", "body"};
  return words;
}

std::vector<std::string> CamerasOf(const Scenario& scenario) {
  std::vector<std::string> cameras = CameraWords();
  for (const physics::Body& body : scenario.scene.bodies) {
    if (body.abstract == physics::Abstract::kCamera) cameras.push_back(body.name);
  }
  return cameras;
}

std::optional<std::string> WhyNoCamera(const Scenario& scenario, const std::string& camera) {
  const std::vector<std::string> cameras = CamerasOf(scenario);
  if (std::ranges::find(cameras, camera) != cameras.end() || ParseOwnCamera(camera))
    return std::nullopt;
  return fmt::format("camera: expected one of {}, or {}, found '{}'", fmt::join(cameras, ", "),
                     kOwnCameraForm, camera);
}

}  // namespace prehend::scenario

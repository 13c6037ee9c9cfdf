// SPDX-License-Identifier: Apache-2.0
// A camera as people type it: where it stands and what it looks at. Tested by
// tests/harness/scenario/scenario/own_camera_test.cc
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

namespace prehend::scenario {

struct OwnCamera {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero(), look_at_m = Eigen::Vector3d::UnitX();
  double view_deg = 33;  ///< vertical field of view
};

/// For messages and help.
inline constexpr const char* kOwnCameraForm = "X,Y,Z:X,Y,Z[:DEG]";

/// "0.9,-0.8,1.3:0.2,-0.1,0.9": a place and what is looked at from there, in metres, and perhaps
/// the vertical field of view, 5 to 120 degrees. Nothing of any other text, of places farther than
/// 100 m, and of two places that are nearer to each other than 1 cm.
std::optional<OwnCamera> ParseOwnCamera(const std::string& text);

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// The recorded motion of a whole body, from a BVH file: finds a person's joints by their names and
// returns her posture at every frame. Tested by tests/harness/scenario/motion/body_motion_test.cc
#pragma once

#include <array>
#include <string>
#include <vector>

#include "harness/scenario/motion/read_bvh.h"
#include "physics/motion/posture.h"

namespace prehend::scenario {

/// Points whose jumps are reported: hips, wrists, ankles.
inline constexpr std::array<const char*, 5> kWatchedPoints = {"hips", "right wrist", "left wrist",
                                                              "right ankle", "left ankle"};
inline constexpr std::size_t kRightAnklePoint = 3, kLeftAnklePoint = 4;

struct BodySample {
  double t_s = 0;  ///< since the first frame
  /// Position of the hips in units of the file, and directions, in our axes: x ahead, y left, z up.
  physics::Posture posture;
  std::array<Eigen::Vector3d, kWatchedPoints.size()> points;  ///< units of the file, our axes
  grammar::Place place;                                       ///< in the file
};

struct BodyTrack {
  std::vector<BodySample> samples;  ///< at least two
  double leg_units = 0;             ///< from hip over knee to ankle, in the hierarchy
  std::string file;
  std::string text;  ///< of the file, for messages
};

/// BVH has y up. A person whose joints are all at 0 stands upright and usually looks along z; where
/// she really looks follows from which hip is the left one.
Result<BodyTrack> ReadBodyTrack(const std::string& path);

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// The recorded motion of a whole body, from a BVH file: finds a person's joints by their names and
// returns her posture at every frame. Tested by tests/harness/scenario/motion/body_motion_test.cc
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/scenario/motion/read_bvh.h"
#include "physics/base/pose.h"
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

// Recorded motions of a hand or head, from files: samples of a tracker with their times. Two
// formats, by the ending of the name: CSV (docs/recorded-input.md) and the JSON of A-Frame's
// motion-capture components. Tested by tests/harness/scenario/motion/hand_motion_test.cc

inline constexpr std::size_t kMaxTrackSamples = 100'000;
inline constexpr double kMaxTrackCoordinate_m =
    100;  ///< from the recording's origin, each coordinate

struct TrackSample {
  double t_s = 0;  ///< since the first sample; increasing
  physics::Pose
      X_RD;  ///< the device in the recording's frame, z up; x ahead, y left, z up of the device
  std::optional<double> trigger;  ///< 0..1
  grammar::Place place;           ///< in the file
};

struct MotionTrack {
  std::vector<TrackSample> samples;  ///< at least two
  std::string file;
  std::string text;            ///< of the file, for messages about samples
  std::set<int> buttons = {};  ///< of a captured device: those that are ever pressed
};

/// Columns with their units in the header: `t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger`.
Result<MotionTrack> ReadMotionCsv(const std::string& path);

/// One device of a recording by aframe-motion-capture-components. A press of `button` without a
/// value is a trigger that rises within `press_s`; a release falls as fast.
struct CapturedDevice {
  std::string name;  ///< its key in the file: "camera", "left", "right"
  int button = 1;
  double press_s = 0.25;
};
Result<MotionTrack> ReadMotionCapture(const std::string& path, const CapturedDevice& device);

/// Gaps and jumps of the samples: errors if larger than the limits, else warnings; at most a dozen.
struct TrackLimits {
  double gap_s = 0.25;
  double jump_m = 0.1;
};
grammar::Diagnostics CheckTrack(const MotionTrack& track, const TrackLimits& limits);

}  // namespace prehend::scenario

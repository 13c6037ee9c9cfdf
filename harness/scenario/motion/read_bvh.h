// SPDX-License-Identifier: Apache-2.0
// BVH files: a hierarchy of joints, and rows of channel values at regular times. What they mean for
// a person is in harness/scenario/motion/body_motion.h. Format: Meredith & Maddock, Motion Capture
// File Formats Explained (2001). Read here and not by assimp, which loses the order of the channels
// and the line and column of an error. Tested by tests/harness/scenario/motion/read_bvh_test.cc
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "harness/base/base/result.h"

namespace prehend::scenario {

inline constexpr std::size_t kMaxBvhJoints = 256;
inline constexpr std::size_t kMaxBvhDepth = 64;
inline constexpr std::size_t kMaxBvhFrames = 20'000;
inline constexpr double kMaxBvhValue = 1e6;  ///< units or degrees

/// How much may be read: of a file that drives a person (the default), or of one that is imported.
struct BvhLimits {
  std::size_t frames = kMaxBvhFrames;
  std::size_t bytes = std::size_t{4} << 20;
};

struct BvhChannel {
  bool turns = false;  ///< about the axis, in degrees; else moves along it, in units of the file
  int axis = 0;        ///< x, y, z of the file
};

struct BvhJoint {
  std::string name;                                  ///< as written; "" for an end site
  int parent = -1;                                   ///< index of a joint before it; -1: a root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the parent, units of the file
  std::vector<BvhChannel> channels;                  ///< in the order in which turns are applied
  std::size_t first_value = 0;                       ///< of its channels in every row
  grammar::Place place;                              ///< of its name
};

struct BvhFile {
  std::vector<BvhJoint> joints;  ///< the root first
  std::size_t values_per_row = 0;
  double frame_time_s = 0;
  std::vector<std::vector<double>> rows;  ///< at least two
  std::vector<grammar::Place> places;     ///< of the rows
  std::string file;
  std::string text;  ///< of the file, for messages
};

/// A file may have several roots: persons, and things beside them.
Result<BvhFile> ReadBvh(const std::string& path, const BvhLimits& limits = {});

struct JointPose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< in the file's axes and units
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// Forward kinematics: all joints at a frame. Channels that move replace the offset along their
/// axis.
std::vector<JointPose> JointPosesAt(const BvhFile& bvh, std::size_t frame);

}  // namespace prehend::scenario

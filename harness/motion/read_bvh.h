// SPDX-License-Identifier: Apache-2.0
// BVH files: a hierarchy of joints, and rows of channel values at regular times. What they mean for
// a person is in harness/motion/body_motion.h. Format: Meredith & Maddock, Motion Capture File
// Formats Explained (2001). Read here and not by assimp, which loses the order of the channels and
// the line and column of an error. Tested by tests/harness/motion/read_bvh_test.cc
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "harness/base/result.h"

namespace prehend::harness {

inline constexpr std::size_t kMaxBvhJoints = 256;
inline constexpr std::size_t kMaxBvhDepth = 64;
inline constexpr std::size_t kMaxBvhFrames = 20'000;
inline constexpr double kMaxBvhValue = 1e6;  ///< units or degrees

struct BvhChannel {
  bool turns = false;  ///< about the axis, in degrees; else moves along it, in units of the file
  int axis = 0;        ///< x, y, z of the file
};

struct BvhJoint {
  std::string name;                                  ///< as written; "" for an end site
  int parent = -1;                                   ///< index of a joint before it; -1: the root
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

Result<BvhFile> ReadBvh(const std::string& path);

}  // namespace prehend::harness

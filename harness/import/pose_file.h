// SPDX-License-Identifier: Apache-2.0
// Poses of bodies over time, as a file has them: its own unit, axes and names. Tested by
// tests/program/import_test.cc
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "harness/import/import_map.h"

namespace prehend::harness::import {

inline constexpr std::size_t kMaxPoseFileBytes = std::size_t{1} << 30;

struct PoseSample {
  double t_s = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();            ///< in the file's unit and axes
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< in the file's axes
  int line = 0;
};

struct PoseBody {
  std::string name;
  std::vector<PoseSample> samples;  ///< times increase; where it is not tracked there is none
};

struct PoseFile {
  std::string file;
  std::string text;                 ///< of the file, for messages
  std::vector<PoseBody> bodies;     ///< those of the map, in its order
  std::vector<std::string> unused;  ///< names of bodies that the map does not mention
  std::size_t rows = 0;
  double first_s = 0, last_s = 0;  ///< of all rows, also of those in which nothing is tracked
};

/// Errors name the place, in the map or in the file of poses; at most a dozen.
Result<PoseFile> ReadCsvPoses(const std::string& path, const MapFile& map);

}  // namespace prehend::harness::import

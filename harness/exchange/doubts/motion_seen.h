// SPDX-License-Identifier: Apache-2.0
// What bodies of a file of poses do, before it is known whether its map is right: where they rest,
// and which hand carries what. Axes are those of the file. Tested by
// tests/program/import_warnings_test.cc
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <set>
#include <vector>

#include "harness/base/base/median.h"
#include "harness/exchange/poses/pose_file.h"

namespace prehend::exchange {

inline constexpr double kHandReach_m = 0.2;     ///< nearer, a hand may hold what is still
inline constexpr double kMoves_m_per_s = 0.06;  ///< slower, it is still

/// A pose at the time of a look; NaN where there is none.
struct BodyLook {
  Eigen::Vector3d p_m = Eigen::Vector3d::Constant(std::nan(""));
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// A thing is less than a centimetre from where it was, for half a second or longer.
struct Rest {
  std::size_t body = 0, begin = 0, end = 0;  ///< looks
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  bool stands = false;  ///< at some time no hand is within reach of it
};

/// A hand and a thing move together.
struct Carry {
  std::size_t thing = 0, hand = 0, begin = 0, end = 0;
  double distance_m = 0;  ///< of their origins
};

struct MotionSeen {
  double look_s = 0.1;                        ///< between two looks at all bodies
  std::vector<const MappedEntity*> entities;  ///< of the bodies
  std::vector<std::vector<BodyLook>> looks;   ///< by body
  std::vector<Rest> rests;                    ///< of things
  std::vector<Carry> carries;
};

MotionSeen MotionIn(const PoseFile& poses, const ImportMap& map, double metres_per_unit);

/// The middle one, of an even number the upper, of `number` of all poses of the file, at least 0
/// each, without keeping them; but of bodies of these names. 0 of none.
double MedianOfPoses(const PoseFile& poses, const std::function<double(const PoseSample&)>& number,
                     const std::set<std::string>& without = {});

/// The usual time between two of them, s.
double UsualStep_s(const PoseSeries& samples);

}  // namespace prehend::exchange

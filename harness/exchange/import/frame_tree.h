// SPDX-License-Identifier: Apache-2.0
// A tree of coordinate frames that move over time (tf of ROS), and where a frame is in another one.
// Tested by tests/program/import_mcap_test.cc
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace prehend::exchange {

struct TimedPose {
  std::int64_t ns = 0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// A frame, or the body of a topic, in its parent.
struct FrameLink {
  std::string parent;
  bool fixed = false;            ///< known once, and for ever
  std::vector<TimedPose> poses;  ///< sorted by time, after Sort()

  /// Sorts, and drops what is said twice. Returns the time of two poses that differ, if there are.
  std::optional<std::int64_t> Sort();
  /// The usual time between two poses.
  std::int64_t UsualStep_ns() const;
};

class FrameTree {
 public:
  /// By the frame's name.
  std::map<std::string, FrameLink> links;

  /// The frame that has no parent. A ring ends somewhere in it.
  std::string RootOf(const std::string& frame) const;

  /// The body in `world`, which must have the same root, at the times of the fastest link between
  /// them. Of the others it is what lies between two poses at most `bridge_ns` (or their usual
  /// step, and half of that) apart; where there is none, there is no pose. One pose, at time 0, if
  /// nothing between them ever moves.
  std::vector<TimedPose> InFrame(const FrameLink& body, const std::string& world,
                                 std::int64_t bridge_ns) const;

 private:
  /// From the body up to its root.
  std::vector<const FrameLink*> WayUp(const FrameLink& body) const;
};

}  // namespace prehend::exchange

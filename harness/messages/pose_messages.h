// SPDX-License-Identifier: Apache-2.0
// Poses and transforms from messages: JSON of Foxglove's and of ROS's types, CDR of ROS 2, and the
// encoding of ROS 1. Tested by tests/program/import_mcap_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/messages/mcap_file.h"

namespace prehend::harness::messages {

enum class MessageContent {
  kPose,        ///< foxglove.PoseInFrame, geometry_msgs/PoseStamped
  kPoses,       ///< foxglove.PosesInFrame, geometry_msgs/PoseArray
  kTransform,   ///< foxglove.FrameTransform, geometry_msgs/TransformStamped
  kTransforms,  ///< foxglove.FrameTransforms, tf2_msgs/TFMessage
  kBodies       ///< JSON: {"bodies": {"cup": {"position": .., "orientation": ..}, "hand": null}}
};

struct MessageFormat {
  MessageContent content = MessageContent::kPose;
  enum class Encoding { kJson, kCdr, kRos1 } encoding = Encoding::kJson;
};

/// Of messages that are not read, none.
std::optional<MessageFormat> FormatOf(const LogChannel& channel);

struct MessagePose {
  /// The frame of a transform, or the name of a body; of a pose "", as its topic names it.
  std::string name;
  std::string frame;                     ///< that it is measured in; "": not said
  std::optional<std::int64_t> stamp_ns;  ///< when it was measured, if the message says it
  bool missing = false;                  ///< not tracked
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector4d xyzw = Eigen::Vector4d(0, 0, 0, 1);  ///< the fields x, y, z, w as they are
};

/// Appends the message's poses. Returns what is wrong with it, or "".
std::string DecodePoses(const MessageFormat& format, std::string_view data,
                        std::vector<MessagePose>& poses);

}  // namespace prehend::harness::messages

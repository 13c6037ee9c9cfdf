// SPDX-License-Identifier: Apache-2.0
// Poses, as messages in JSON, in CDR (ROS 2) and in the encoding of ROS 1 say them. Tested by
// tests/program/import_mcap_test.cc and tests/program/import_messages_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/exchange/messages/pose_fields.h"

namespace prehend::exchange {

inline constexpr std::uint32_t kMostPosesOfMessage = 10'000;
inline constexpr std::size_t kMostBodyNameBytes = 200;  ///< the rest of a name is not read

struct MessagePose {
  std::size_t field = 0;  ///< which of the type's pose fields
  /// Of each list on the way to it, from the outside: the element's name, or its number.
  std::vector<std::string> keys;
  /// Of a transform the child frame; of one of several named bodies its name.
  std::string name;
  std::string frame;                     ///< that it is measured in; "": not said
  std::optional<std::int64_t> stamp_ns;  ///< when it was measured, if the message says it
  bool missing = false;                  ///< not tracked
  bool oriented = true;                  ///< else its orientation is not known
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector4d xyzw = Eigen::Vector4d(0, 0, 0, 1);  ///< the fields x, y, z, w as they are
};

enum class JsonContent {
  kPose,        ///< foxglove.PoseInFrame, geometry_msgs/PoseStamped
  kPoses,       ///< foxglove.PosesInFrame, geometry_msgs/PoseArray
  kTransform,   ///< foxglove.FrameTransform, geometry_msgs/TransformStamped
  kTransforms,  ///< foxglove.FrameTransforms, tf2_msgs/TFMessage
  kBodies       ///< {"bodies": {"cup": {"position": .., "orientation": ..}, "hand": null}}
};

/// Appends the message's poses. Returns what is wrong with it, or "".
std::string DecodeJsonPoses(JsonContent content, std::string_view data,
                            std::vector<MessagePose>& poses);

/// Appends the message's poses: all of `wanted` fields, of others the first ones. Returns what is
/// wrong with the message, or "".
std::string DecodeBinaryPoses(const PoseLayout& layout, bool ros1, std::string_view data,
                              const std::vector<bool>& wanted, std::vector<MessagePose>& poses);

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
// Poses and transforms from messages in JSON: Foxglove's types, some of ROS, and one of our own.
// Tested by tests/program/import_mcap_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/exchange/messages/message_pose.h"

namespace prehend::exchange {

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

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
// Poses from messages in CDR (ROS 2) and in the encoding of ROS 1, by the definition of their type.
// Tested by tests/program/import_messages_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/exchange/messages/message_pose.h"
#include "harness/exchange/messages/pose_fields.h"

namespace prehend::exchange {

/// Appends the message's poses: all of `wanted` fields, of others the first ones. Returns what is
/// wrong with the message, or "".
std::string DecodeBinaryPoses(const PoseLayout& layout, bool ros1, std::string_view data,
                              const std::vector<bool>& wanted, std::vector<MessagePose>& poses);

}  // namespace prehend::exchange

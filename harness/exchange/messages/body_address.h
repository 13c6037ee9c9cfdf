// SPDX-License-Identifier: Apache-2.0
// How a map says which pose of a topic's messages is meant: "/odom", "/frame[Cup]" (an element of a
// list, by its name or number), "/hands:left.pose", "/frame:rigid_bodies[Cup].pose". Tested by
// tests/harness/exchange/messages/pose_fields_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/exchange/messages/pose_fields.h"

namespace prehend::exchange {

struct BodyAddress {
  /// Names of fields from the message on, up to the pose or to where only one is left; or none.
  std::vector<PoseField::Step> steps;
  std::vector<std::string> keys;  ///< of each list on the way
};

/// What follows the topic: "", "[Cup]", ":left.pose". None if it is no address.
std::optional<BodyAddress> ParseBodyAddress(std::string_view text);

/// Which of the fields it can mean. A position only if no pose is meant, or by its whole path.
std::vector<std::size_t> FieldsOf(const BodyAddress& address, const std::vector<PoseField>& fields);

/// The shortest address of a body, with its topic.
std::string AddressOf(const std::string& topic, const std::vector<PoseField>& fields,
                      std::size_t field, const std::vector<std::string>& keys);

}  // namespace prehend::exchange

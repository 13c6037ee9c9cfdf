// SPDX-License-Identifier: Apache-2.0
// Definitions of message types, as bags and MCAP files carry them: the text of ROS 1 and ROS 2
// ("ros1msg", "ros2msg"), in which the types that a type uses follow it. Tested by
// tests/harness/exchange/messages/message_definition_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::exchange {

enum class Basic : std::uint8_t {
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kTime,  ///< and a duration: two numbers of 32 bits
  kText,
  kWideText,
  kMessage
};

struct DefinedField {
  std::string name;
  Basic basic = Basic::kMessage;
  std::size_t type = 0;  ///< of a message: which of the definition's types
  enum class Many : std::uint8_t { kOne, kFixed, kAny } many = Many::kOne;
  std::uint32_t count = 0;  ///< kFixed: of its elements
};

struct DefinedType {
  std::string name;  ///< "geometry_msgs/Pose"
  std::vector<DefinedField> fields;
  std::uint64_t least_bytes = 0;  ///< without alignment
  bool same_size = true;          ///< no text and no list of any length is in it
};

struct MessageDefinition {
  std::vector<DefinedType> types;  ///< those in use; the first one is the message's
};

/// Of basic types; of texts that of their length.
std::uint64_t BytesOf(Basic basic);

/// "pkg/msg/Type" is called "pkg/Type".
std::string PlainTypeName(std::string_view name);

/// `type`: the message's. Types that the text lacks are looked up in TextOfKnownType(). Returns
/// what is wrong, with its line, or "".
std::string ReadDefinition(std::string_view type, std::string_view text, bool ros1,
                           MessageDefinition& definition);

/// The definition of "geometry_msgs/Pose" and its like, or "".
std::string_view TextOfKnownType(std::string_view type, bool ros1);

}  // namespace prehend::exchange

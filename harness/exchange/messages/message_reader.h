// SPDX-License-Identifier: Apache-2.0
// Reads the poses in the messages of a channel, whatever their encoding is. Tested by
// tests/program/import_messages_test.cc
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "harness/exchange/messages/log_file.h"
#include "harness/exchange/messages/pose_fields.h"

namespace prehend::exchange {

class MessageReader {
 public:
  /// What the poses are of.
  enum class Bodies {
    kOfTopic,  ///< found by the topic, and a place in its messages
    kFrames,   ///< of tf: links of the tree of frames, too
    kByName    ///< each has a name of its own
  };

  Bodies bodies() const { return bodies_; }
  /// Where its messages have poses; of kByName none.
  const std::vector<PoseField>& fields() const { return *fields_; }
  /// Appends a message's poses: all of `wanted` fields, some of the others. Returns what is wrong
  /// with it, or "".
  std::string Decode(std::string_view data, const std::vector<bool>& wanted,
                     std::vector<MessagePose>& poses) const;

 private:
  friend class MessageReaders;
  struct Binary {
    std::shared_ptr<const PoseLayout> layout;
    bool ros1 = false;
  };
  Bodies bodies_ = Bodies::kOfTopic;
  const std::vector<PoseField>* fields_ = nullptr;
  std::variant<JsonContent, Binary> how_;
};

/// Of the channels of a file. What is done once for a type is kept.
class MessageReaders {
 public:
  /// Whether its messages are transforms of tf, which may join bodies that a map names.
  static bool IsOfFrames(const LogChannel& channel);
  /// The definition of the type of its messages, as CDR or ROS 1. Returns why there is none, or "".
  static std::string Definition(const LogChannel& channel, MessageDefinition& definition);
  /// Null if its messages are not read, or have no pose: then `why` says so.
  std::shared_ptr<const MessageReader> Of(const LogChannel& channel, std::string& why);

 private:
  std::shared_ptr<const MessageReader> Make(const LogChannel& channel, std::string& why);

  using Key = std::pair<std::string, const void*>;  ///< type and encoding, and the definition
  std::map<Key, std::pair<std::shared_ptr<const MessageReader>, std::string>> known_;
};

}  // namespace prehend::exchange

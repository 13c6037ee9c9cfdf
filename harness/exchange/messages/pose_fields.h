// SPDX-License-Identifier: Apache-2.0
// Where poses are in the messages of a type, and what is said about them there: their bodies'
// names, frames, times, whether they are tracked. What the fields are called and what they hold
// decides it (docs/motion-capture.md). Tested by
// tests/harness/exchange/messages/pose_fields_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "harness/exchange/messages/log_file.h"
#include "harness/exchange/messages/message_definition.h"

namespace prehend::exchange {

inline constexpr std::size_t kMostPoseFields = 100;  ///< of a type; of more, the first ones

/// A place at which messages of a type have a pose, or a list has one in each element.
struct PoseField {
  struct Step {
    std::string field;
    bool list = false;
    bool operator==(const Step&) const = default;
  };
  std::vector<Step> steps;  ///< none: the message is a pose
  bool oriented = true;     ///< else it is a position only

  std::size_t Lists() const;
  bool operator==(const PoseField&) const = default;
};

/// What a field of a type tells.
enum class Role : std::uint8_t {
  kNothing,
  kHeader,
  kStamp,
  kFrame,
  kName,        ///< of the body
  kOtherName,   ///< if there is no name: the first of these
  kChildFrame,  ///< if there is none of them
  kNamespace,   ///< with the id
  kId,
  kNames,  ///< of the elements of the lists beside it
  kTracked,
  kNotTracked,
  kX,
  kY,
  kZ,
  kQx,
  kQy,
  kQz,
  kQw,
  kPosition,
  kOrientation,
};

/// Of messages of one type, the parts in which there are poses.
struct PoseLayout {
  struct Child {
    std::size_t field = 0;  ///< of the type
    std::size_t part = 0;   ///< what an element of it is
  };
  struct Part {
    std::size_t type = 0;         ///< of the definition
    std::size_t roles = 0;        ///< of its fields, in `roles`
    std::vector<Child> children;  ///< in the order of their fields
    int pose = -1;                ///< which of `fields` it is
  };
  MessageDefinition definition;
  std::vector<std::vector<Role>> roles;  ///< of each type, and of each in a part with a header
  std::vector<PoseField> fields;
  std::vector<Part> parts;  ///< the first one is the message
};

PoseLayout LayoutOf(MessageDefinition definition);

/// Of a message with numbers x, y, z (and w), such as a point: their roles.
std::vector<Role> RolesOfNumbers(const DefinedType& type);

/// How a map says which pose of a topic's messages is meant: "/odom", "/frame[Cup]" (an element of
/// a list, by its name or number), "/hands:left.pose", "/frame:rigid_bodies[Cup].pose".
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

// Poses, as messages in JSON, in CDR (ROS 2) and in the encoding of ROS 1 say them. Tested by
// tests/program/import_mcap_test.cc and tests/program/import_messages_test.cc

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

/// Of a message of this type, the numbers of a field: "position" of a list beside the texts "name",
/// by one of them or from 0: {field, key}; a single number by its name: "gripper.width". Without a
/// field, that of a type that has only one list, or only one number. Appends nothing if the message
/// has no such element. Returns what is wrong with the message or with the address, or "".
std::string DecodeBinaryNumber(const MessageDefinition& definition, bool ros1,
                               std::string_view data, const BodyAddress& address,
                               std::vector<double>& numbers, std::optional<std::int64_t>& stamp_ns);

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

// Reads the poses in the messages of a channel, whatever their encoding is.

class MessageReader {
 public:
  /// What the poses are of.
  enum class Bodies {
    kOfTopic,  ///< found by the topic, and a place in its messages
    kFrames,   ///< of tf: links of the tree of frames, too
    kByName    ///< each has a name of its own
  };

  Bodies bodies() const { return bodies_; }
  /// What viewers draw, as our exports tell them to: whose poses are no bodies that were forgotten.
  bool is_drawn() const { return is_drawn_; }
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
  bool is_drawn_ = false;
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

// SPDX-License-Identifier: Apache-2.0
// See harness/messages/pose_messages.h. Tested by tests/program/import_mcap_test.cc
#include "harness/messages/pose_messages.h"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/base/text_file.h"
#include "harness/messages/byte_reader.h"

namespace prehend::harness::messages {
namespace {

using Encoding = MessageFormat::Encoding;
using Json = nlohmann::json;

constexpr std::size_t kMostJsonBytes = std::size_t{1} << 20;
constexpr std::uint32_t kMostPosesOfMessage = 10'000;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

bool IsTransform(MessageContent content) {
  return content == MessageContent::kTransform || content == MessageContent::kTransforms;
}

/// CDR, and the encoding of ROS 1, which has no alignment, a number in each header, and texts
/// without a zero at their end.
class BinaryDecoder {
 public:
  BinaryDecoder(MessageFormat format, std::string_view data, std::vector<MessagePose>& poses)
      : format_(format), reader_{.bytes = data}, poses_(poses) {}

  std::string Decode() {
    if (format_.encoding == Encoding::kCdr) {
      const std::string problem = TakeEncapsulation();
      if (!problem.empty()) return problem;
    }
    std::uint32_t count = 1;
    MessagePose pose;
    if (format_.content == MessageContent::kPoses) TakeHeader(pose);
    if (format_.content == MessageContent::kPoses || format_.content == MessageContent::kTransforms)
      count = reader_.Number<std::uint32_t>();
    if (count > kMostPosesOfMessage)
      return fmt::format("it announces {} poses; at most {} are read", count, kMostPosesOfMessage);
    for (std::uint32_t i = 0; i < count && reader_.ok; ++i) {
      if (format_.content != MessageContent::kPoses) TakeHeader(pose);
      if (IsTransform(format_.content)) pose.name = Text();
      for (int axis = 0; axis < 3; ++axis) pose.p[axis] = reader_.Number<double>();
      for (int axis = 0; axis < 4; ++axis) pose.xyzw[axis] = reader_.Number<double>();
      poses_.push_back(pose);
    }
    if (!reader_.ok) return "it is cut off, or not of its type";
    if (reader_.left() > 7) return fmt::format("{} bytes too many for its type", reader_.left());
    return "";
  }

 private:
  /// Which byte is first, and how far numbers are aligned: RTPS 2.5, 10.2.
  std::string TakeEncapsulation() {
    const std::string_view head = reader_.Bytes(4);
    if (!reader_.ok) return "it is cut off";
    const auto kind = static_cast<unsigned char>(head[1]);
    const bool plain = head[0] == 0 && (kind <= 1 || kind == 6 || kind == 7);
    if (!plain)
      return fmt::format("CDR of the kind {:02x}{:02x}; 0000, 0001, 0006 and 0007 are read",
                         static_cast<unsigned char>(head[0]), kind);
    reader_ = {.bytes = reader_.bytes.substr(4),
               .big_endian = kind % 2 == 0,
               .most_alignment = std::size_t{kind <= 1 ? 8u : 4u}};
    return "";
  }

  void TakeHeader(MessagePose& pose) {
    if (format_.encoding == Encoding::kRos1) reader_.Number<std::uint32_t>();
    const auto seconds = reader_.Number<std::uint32_t>();
    const auto nanoseconds = reader_.Number<std::uint32_t>();
    pose.stamp_ns = seconds * kNanosecondsPerSecond + nanoseconds;
    pose.frame = Text();
  }

  std::string Text() {
    std::string_view text = reader_.Text();
    if (format_.encoding == Encoding::kCdr && text.ends_with('\0')) text.remove_suffix(1);
    return ReadableName(text.substr(0, 200));
  }

  const MessageFormat format_;
  ByteReader reader_;
  std::vector<MessagePose>& poses_;
};

class JsonDecoder {
 public:
  JsonDecoder(MessageContent content, std::vector<MessagePose>& poses)
      : content_(content), poses_(poses) {}

  std::string Decode(std::string_view data) {
    // Other topics are of anything.
    if (content_ == MessageContent::kBodies && data.find("\"bodies\"") == std::string_view::npos)
      return "";
    if (data.size() > kMostJsonBytes)
      return fmt::format("more than {} MiB of JSON", kMostJsonBytes >> 20);
    const Json message = Json::parse(data, nullptr, /*allow_exceptions=*/false);
    if (!message.is_object()) return "it is no JSON object";
    switch (content_) {
      case MessageContent::kPose:
      case MessageContent::kTransform:
        TakeOne(message);
        break;
      case MessageContent::kTransforms:
        for (const Json& transform : List(message, "transforms")) TakeOne(transform);
        break;
      case MessageContent::kPoses:
        for (const Json& pose : List(message, "poses")) {
          MessagePose read = WithHeader(message);
          TakePose(pose, "position", "orientation", read);
        }
        break;
      case MessageContent::kBodies:
        TakeBodies(message);
    }
    return problem_;
  }

 private:
  void Fail(std::string why) {
    if (problem_.empty()) problem_ = std::move(why);
  }

  const Json& Member(const Json& object, const char* key) {
    static const Json kNothing;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && found != object.end() ? *found : kNothing;
  }

  const Json& List(const Json& object, const char* key) {
    static const Json kEmpty = Json::array();
    const Json& list = Member(object, key);
    if (list.is_array() && list.size() <= kMostPosesOfMessage) return list;
    Fail(fmt::format("'{}': expected a list of at most {}", key, kMostPosesOfMessage));
    return kEmpty;
  }

  std::string Text(const Json& object, const char* key) {
    const Json& text = Member(object, key);
    if (text.is_string()) return ReadableName(text.get_ref<const std::string&>().substr(0, 200));
    if (!text.is_null()) Fail(fmt::format("'{}': expected a text", key));
    return "";
  }

  /// With the frame and the time, which stand in a header or beside the pose.
  MessagePose WithHeader(const Json& message) {
    MessagePose pose;
    const Json& header = Member(message, "header");
    const Json& origin = header.is_object() ? header : message;
    pose.frame = Text(origin, message.contains("parent_frame_id") ? "parent_frame_id" : "frame_id");
    const Json& stamp = Member(origin, header.is_object() ? "stamp" : "timestamp");
    if (stamp.is_null()) return pose;
    const auto part = [&](std::initializer_list<const char*> names) -> std::int64_t {
      for (const char* name : names) {
        const Json& number = Member(stamp, name);
        if (number.is_number_integer() && number.get<std::int64_t>() >= 0 &&
            number.get<std::int64_t>() < std::int64_t{1} << 32)
          return number.get<std::int64_t>();
      }
      Fail("its time: expected {\"sec\": .., \"nsec\": ..}");
      return 0;
    };
    pose.stamp_ns =
        part({"sec", "secs"}) * kNanosecondsPerSecond + part({"nsec", "nanosec", "nsecs"});
    return pose;
  }

  void TakeOne(const Json& message) {
    MessagePose pose = WithHeader(message);
    if (content_ == MessageContent::kPose)
      return TakePose(Member(message, "pose"), "position", "orientation", pose);
    pose.name = Text(message, "child_frame_id");
    const Json& inner = Member(message, "transform");
    TakePose(inner.is_object() ? inner : message, "translation", "rotation", pose);
  }

  void TakePose(const Json& object, const char* position, const char* orientation,
                MessagePose& pose) {
    constexpr std::array kFields = {"x", "y", "z", "w"};
    const auto number = [&](const char* key, int axis) {
      const Json& value = Member(Member(object, key), kFields[static_cast<std::size_t>(axis)]);
      if (value.is_number()) return value.get<double>();
      if (!value.is_null() || !Member(object, key).is_object() ||
          !Member(object, key).contains(kFields[static_cast<std::size_t>(axis)]))
        Fail(fmt::format("'{}.{}': expected a number", key,
                         kFields[static_cast<std::size_t>(axis)]));
      return std::numeric_limits<double>::quiet_NaN();  // as JSON writes it: null
    };
    for (int axis = 0; axis < 3; ++axis) pose.p[axis] = number(position, axis);
    for (int axis = 0; axis < 4; ++axis) pose.xyzw[axis] = number(orientation, axis);
    poses_.push_back(pose);
  }

  void TakeBodies(const Json& message) {
    const Json& bodies = Member(message, "bodies");
    if (!bodies.is_object() || bodies.size() > kMostPosesOfMessage)
      return Fail("'bodies': expected an object with a pose for each body");
    for (const auto& [name, body] : bodies.items()) {
      MessagePose pose = WithHeader(message);
      pose.name = ReadableName(name.substr(0, 200));
      if (body.is_null()) {
        pose.missing = true;
        poses_.push_back(pose);
      } else {
        TakePose(body, "position", "orientation", pose);
      }
    }
  }

  const MessageContent content_;
  std::vector<MessagePose>& poses_;
  std::string problem_;
};

}  // namespace

std::optional<MessageFormat> FormatOf(const LogChannel& channel) {
  static const std::map<std::string, MessageContent> kContents = {
      {"foxglove.PoseInFrame", MessageContent::kPose},
      {"foxglove.PosesInFrame", MessageContent::kPoses},
      {"foxglove.FrameTransform", MessageContent::kTransform},
      {"foxglove.FrameTransforms", MessageContent::kTransforms},
      {"geometry_msgs/PoseStamped", MessageContent::kPose},
      {"geometry_msgs/PoseArray", MessageContent::kPoses},
      {"geometry_msgs/TransformStamped", MessageContent::kTransform},
      {"tf2_msgs/TFMessage", MessageContent::kTransforms},
      {"tf/tfMessage", MessageContent::kTransforms}};
  std::string type = channel.schema;
  if (const std::size_t at = type.find("/msg/"); at != std::string::npos) type.erase(at, 4);
  const auto known = kContents.find(type);
  const std::string& encoding = channel.message_encoding;
  if (encoding == "json")
    return MessageFormat{known == kContents.end() ? MessageContent::kBodies : known->second,
                         Encoding::kJson};
  if (known == kContents.end() || type.starts_with("foxglove")) return std::nullopt;
  if (encoding == "cdr") return MessageFormat{known->second, Encoding::kCdr};
  if (encoding == "ros1") return MessageFormat{known->second, Encoding::kRos1};
  return std::nullopt;
}

std::string DecodePoses(const MessageFormat& format, std::string_view data,
                        std::vector<MessagePose>& poses) {
  return format.encoding == Encoding::kJson ? JsonDecoder(format.content, poses).Decode(data)
                                            : BinaryDecoder(format, data, poses).Decode();
}

}  // namespace prehend::harness::messages

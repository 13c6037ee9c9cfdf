// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "harness/base/base/text_file.h"
#include "harness/exchange/messages/pose_fields.h"

namespace prehend::exchange {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostJsonBytes = std::size_t{1} << 20;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

class JsonDecoder {
 public:
  JsonDecoder(JsonContent content, std::vector<MessagePose>& poses)
      : content_(content), poses_(poses) {}

  std::string Decode(std::string_view data) {
    // Other topics are of anything.
    if (content_ == JsonContent::kBodies && data.find("\"bodies\"") == std::string_view::npos)
      return "";
    if (data.size() > kMostJsonBytes)
      return fmt::format("more than {} MiB of JSON", kMostJsonBytes >> 20);
    const Json message = Json::parse(data, nullptr, /*allow_exceptions=*/false);
    if (!message.is_object()) return "it is no JSON object";
    switch (content_) {
      case JsonContent::kPose:
      case JsonContent::kTransform:
        TakeOne(message);
        break;
      case JsonContent::kTransforms:
        for (const Json& transform : List(message, "transforms")) TakeOne(transform);
        break;
      case JsonContent::kPoses:
        for (const Json& pose : List(message, "poses")) {
          MessagePose read = WithHeader(message);
          read.keys.push_back(std::to_string(poses_.size()));
          TakePose(pose, "position", "orientation", read);
        }
        break;
      case JsonContent::kBodies:
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
    if (text.is_string())
      return ReadableName(text.get_ref<const std::string&>().substr(0, kMostBodyNameBytes));
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
    if (content_ == JsonContent::kPose)
      return TakePose(Member(message, "pose"), "position", "orientation", pose);
    pose.name = Text(message, "child_frame_id");
    if (content_ == JsonContent::kTransforms) pose.keys.push_back(pose.name);
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
      pose.name = ReadableName(name.substr(0, kMostBodyNameBytes));
      if (body.is_null()) {
        pose.missing = true;
        poses_.push_back(pose);
      } else {
        TakePose(body, "position", "orientation", pose);
      }
    }
  }

  const JsonContent content_;
  std::vector<MessagePose>& poses_;
  std::string problem_;
};

}  // namespace

std::string DecodeJsonPoses(JsonContent content, std::string_view data,
                            std::vector<MessagePose>& poses) {
  return JsonDecoder(content, poses).Decode(data);
}

}  // namespace prehend::exchange

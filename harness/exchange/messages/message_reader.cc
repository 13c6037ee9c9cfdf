// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/messages/message_reader.h"

#include <fmt/format.h>

#include "harness/base/base/text_file.h"
#include "harness/exchange/messages/message_definition.h"
#include "harness/exchange/messages/pose_fields.h"

namespace prehend::exchange {
namespace {

/// Of types that are read as JSON.
const std::map<std::string, JsonContent>& JsonContents() {
  static const std::map<std::string, JsonContent> kContents = {
      {"foxglove.PoseInFrame", JsonContent::kPose},
      {"foxglove.PosesInFrame", JsonContent::kPoses},
      {"foxglove.FrameTransform", JsonContent::kTransform},
      {"foxglove.FrameTransforms", JsonContent::kTransforms},
      {"geometry_msgs/PoseStamped", JsonContent::kPose},
      {"geometry_msgs/PoseArray", JsonContent::kPoses},
      {"geometry_msgs/TransformStamped", JsonContent::kTransform},
      {"tf2_msgs/TFMessage", JsonContent::kTransforms},
      {"tf/tfMessage", JsonContent::kTransforms}};
  return kContents;
}

const std::vector<PoseField>& FieldsOf(JsonContent content) {
  static const std::vector<PoseField> kFields[] = {
      {{.steps = {{.field = "pose"}}}},
      {{.steps = {{.field = "poses", .list = true}}}},
      {{.steps = {{.field = "transform"}}}},
      {{.steps = {{.field = "transforms", .list = true}, {.field = "transform"}}}},
      {}};
  return kFields[static_cast<std::size_t>(content)];
}

}  // namespace

std::string MessageReader::Decode(std::string_view data, const std::vector<bool>& wanted,
                                  std::vector<MessagePose>& poses) const {
  if (const auto* json = std::get_if<JsonContent>(&how_))
    return DecodeJsonPoses(*json, data, poses);
  const Binary& binary = std::get<Binary>(how_);
  return DecodeBinaryPoses(*binary.layout, binary.ros1, data, wanted, poses);
}

bool MessageReaders::IsOfFrames(const LogChannel& channel) {
  const auto known = JsonContents().find(PlainTypeName(channel.schema));
  return known != JsonContents().end() &&
         (known->second == JsonContent::kTransform || known->second == JsonContent::kTransforms);
}

std::shared_ptr<const MessageReader> MessageReaders::Of(const LogChannel& channel,
                                                        std::string& why) {
  const Key key = {
      channel.schema + '\n' + channel.message_encoding + '\n' + channel.schema_encoding,
      channel.definition.data()};
  auto known = known_.find(key);
  if (known == known_.end()) {
    std::string problem;
    std::shared_ptr<const MessageReader> reader = Make(channel, problem);
    known = known_.emplace(key, std::pair(std::move(reader), std::move(problem))).first;
  }
  why = known->second.second;
  return known->second.first;
}

std::string MessageReaders::Definition(const LogChannel& channel, MessageDefinition& definition) {
  const std::string type = PlainTypeName(channel.schema);
  const std::string& encoding = channel.message_encoding;
  const std::string why = fmt::format("{} ({})", type.empty() ? "no schema" : ReadableName(type),
                                      ReadableName(encoding));
  const bool ros1 = encoding == "ros1";
  if (!ros1 && encoding != "cdr") return why;
  const bool has_text =
      channel.schema_encoding == (ros1 ? "ros1msg" : "ros2msg") && !channel.definition.empty();
  if (!has_text && TextOfKnownType(type, ros1).empty())
    return why + (channel.definition.empty()
                      ? ", whose definition is not in the file"
                      : fmt::format(", whose definition is in '{}', which is not read",
                                    ReadableName(channel.schema_encoding.substr(0, 40))));
  const std::string problem =
      ReadDefinition(type, has_text ? channel.definition : std::string_view(), ros1, definition);
  return problem.empty() ? "" : why + "; " + problem;
}

std::shared_ptr<const MessageReader> MessageReaders::Make(const LogChannel& channel,
                                                          std::string& why) {
  auto reader = std::make_shared<MessageReader>();
  const std::string type = PlainTypeName(channel.schema);
  const std::string& encoding = channel.message_encoding;
  why = fmt::format("{} ({})", type.empty() ? "no schema" : ReadableName(type),
                    ReadableName(encoding));
  if (IsOfFrames(channel)) reader->bodies_ = MessageReader::Bodies::kFrames;
  if (encoding == "json") {
    const auto known = JsonContents().find(type);
    const JsonContent content =
        known == JsonContents().end() ? JsonContent::kBodies : known->second;
    if (content == JsonContent::kBodies) reader->bodies_ = MessageReader::Bodies::kByName;
    reader->how_ = content;
    reader->fields_ = &FieldsOf(content);
    return reader;
  }
  MessageDefinition definition;
  const bool ros1 = encoding == "ros1";
  if (std::string problem = Definition(channel, definition); !problem.empty()) {
    why = std::move(problem);
    return nullptr;
  }
  auto layout = std::make_shared<const PoseLayout>(LayoutOf(std::move(definition)));
  if (layout->fields.empty()) {
    why += ", which has no pose";
    return nullptr;
  }
  reader->fields_ = &layout->fields;
  reader->how_ = MessageReader::Binary{.layout = std::move(layout), .ros1 = ros1};
  why.clear();
  return reader;
}

}  // namespace prehend::exchange

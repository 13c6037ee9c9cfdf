// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/messages/pose_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/messages/message_definition.h"

namespace prehend::exchange {
namespace {

using Many = DefinedField::Many;

bool IsOneOf(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

bool IsReal(const DefinedField& field) {
  return field.basic == Basic::kFloat32 || field.basic == Basic::kFloat64;
}

bool IsInteger(Basic basic) { return basic >= Basic::kInt8 && basic <= Basic::kUint64; }

Role RoleOfNumber(const DefinedField& field) {
  static const std::map<std::string, Role> kRoles = {
      {"x", Role::kX},   {"y", Role::kY},   {"z", Role::kZ},  {"qx", Role::kQx},
      {"qy", Role::kQy}, {"qz", Role::kQz}, {"qw", Role::kQw}};
  const auto role = kRoles.find(LowerCase(field.name));
  const bool is_number = IsReal(field) && field.many == Many::kOne;
  return is_number && role != kRoles.end() ? role->second : Role::kNothing;
}

bool Has(const std::vector<Role>& roles, std::initializer_list<Role> wanted) {
  return std::ranges::all_of(wanted,
                             [&](Role role) { return std::ranges::count(roles, role) == 1; });
}

Role RoleOfFlag(std::string name) {
  for (const std::string_view before : {"b_", "is_"}) {
    if (name.starts_with(before)) name.erase(0, before.size());
  }
  if (IsOneOf(name, {"valid", "tracked", "track_valid", "tracking_valid", "pose_valid", "visible"}))
    return Role::kTracked;
  return IsOneOf(name, {"occluded", "lost"}) ? Role::kNotTracked : Role::kNothing;
}

Role RoleOfText(const std::string& name) {
  if (name == "frame_id" || name == "parent_frame_id") return Role::kFrame;
  if (name == "child_frame_id") return Role::kChildFrame;
  if (name == "name") return Role::kName;
  if (name == "ns") return Role::kNamespace;
  return name.ends_with("_name") || IsOneOf(name, {"label", "id"}) ? Role::kOtherName
                                                                   : Role::kNothing;
}

class LayoutMaker {
 public:
  explicit LayoutMaker(PoseLayout& layout) : layout_(layout), types_(layout.definition.types) {
    has_within_.assign(types_.size(), -1);
    for (const bool in_frame : {false, true}) {
      for (const DefinedType& type : types_) layout_.roles.push_back(RolesOf(type, in_frame));
    }
  }

  void Make() { AddPart(0, "", /*in_frame=*/false); }

 private:
  std::string_view ShortName(std::size_t type) const {
    const std::string_view name = types_[type].name;
    return name.substr(name.find('/') + 1);
  }

  bool IsPoint(std::size_t type) const {
    const std::vector<Role> roles = RolesOfNumbers(types_[type]);
    return Has(roles, {Role::kX, Role::kY, Role::kZ}) && !Has(roles, {Role::kQw});
  }

  bool IsQuaternion(const DefinedField& field) const {
    if (field.basic != Basic::kMessage)
      return IsReal(field) && field.many == Many::kFixed && field.count == 4 &&
             IsOneOf(LowerCase(field.name), {"orientation", "rotation", "quaternion", "q"});
    const DefinedType& type = types_[field.type];
    return field.many == Many::kOne &&
           Has(RolesOfNumbers(type), {Role::kQx, Role::kQy, Role::kQz, Role::kQw}) &&
           type.fields.size() == 4;
  }

  static bool IsCalledPosition(const std::string& field) {
    return IsOneOf(LowerCase(field), {"position", "translation", "pos", "point", "location"});
  }

  /// Of a pose, beside its orientation.
  bool IsPosition(const DefinedField& field) const {
    if (field.basic != Basic::kMessage)
      return IsReal(field) && field.many == Many::kFixed && field.count == 3 &&
             IsCalledPosition(field.name);
    return field.many == Many::kOne && IsPoint(field.type) &&
           (IsCalledPosition(field.name) || ShortName(field.type).starts_with("Point"));
  }

  /// `in_frame`: a header around it says what it is measured in, so that a frame of its own is its
  /// name.
  std::vector<Role> RolesOf(const DefinedType& type, bool in_frame) const {
    std::vector<Role> roles(type.fields.size(), Role::kNothing);
    for (std::size_t i = 0; i < roles.size(); ++i) {
      const DefinedField& field = type.fields[i];
      const std::string name = LowerCase(field.name);
      if (field.basic == Basic::kText && field.many == Many::kAny &&
          IsOneOf(name, {"name", "names", "frames", "labels"}))
        roles[i] = Role::kNames;
      if (field.many != Many::kOne) continue;
      if (field.basic == Basic::kMessage && ShortName(field.type) == "Header")
        roles[i] = Role::kHeader;
      if (field.basic == Basic::kTime && IsOneOf(name, {"stamp", "timestamp", "time"}))
        roles[i] = Role::kStamp;
      if (field.basic == Basic::kText) roles[i] = RoleOfText(name);
      if (field.basic == Basic::kBool) roles[i] = RoleOfFlag(name);
      if (IsInteger(field.basic) &&
          (name == "id" || name.ends_with("_id") || field.name.ends_with("ID")))
        roles[i] = Role::kId;
    }
    const bool in_other = in_frame && std::ranges::count(roles, Role::kHeader) == 0;
    if (in_other) std::ranges::replace(roles, Role::kFrame, Role::kOtherName);
    AddPoseRoles(type, roles);
    return roles;
  }

  /// Of the fields that make it a pose, if it is one.
  void AddPoseRoles(const DefinedType& type, std::vector<Role>& roles) const {
    const std::vector<Role> numbers = RolesOfNumbers(type);
    std::vector<std::size_t> positions, orientations;
    for (std::size_t i = 0; i < type.fields.size(); ++i) {
      if (IsPosition(type.fields[i])) positions.push_back(i);
      if (IsQuaternion(type.fields[i])) orientations.push_back(i);
      if (numbers[i] != Role::kNothing) roles[i] = numbers[i];
    }
    const auto is_called = [&](std::size_t i) { return IsCalledPosition(type.fields[i].name); };
    if (positions.size() > 1 && std::ranges::count_if(positions, is_called) == 1)
      positions = {*std::ranges::find_if(positions, is_called)};
    if (positions.size() != 1) return;
    const bool by_itself = type.fields[positions[0]].basic != Basic::kMessage;
    if (orientations.size() == 1) roles[orientations[0]] = Role::kOrientation;
    if (orientations.size() == 1 || by_itself) roles[positions[0]] = Role::kPosition;
  }

  enum class Shape { kNone, kPosition, kPose };

  /// What a message of this type is itself, as a field of this name.
  Shape ShapeOf(std::size_t type, const std::vector<Role>& roles, const std::string& called) const {
    if (Has(roles, {Role::kPosition}))
      return Has(roles, {Role::kOrientation}) ? Shape::kPose : Shape::kPosition;
    if (!Has(roles, {Role::kX, Role::kY, Role::kZ})) return Shape::kNone;
    if (Has(roles, {Role::kQx, Role::kQy, Role::kQz, Role::kQw})) return Shape::kPose;
    const bool is_point = IsCalledPosition(called) || ShortName(type).starts_with("Point");
    return is_point && IsPoint(type) ? Shape::kPosition : Shape::kNone;
  }

  /// Whether poses may be within a field that tells nothing else.
  static bool IsGoneInto(const DefinedField& field, Role role) {
    return role == Role::kNothing && field.basic == Basic::kMessage;
  }

  bool HasPoses(const DefinedField& field) {
    if (ShapeOf(field.type, layout_.roles[field.type], field.name) != Shape::kNone) return true;
    int& within = has_within_[field.type];
    if (within < 0) {
      const DefinedType& type = types_[field.type];
      const std::vector<Role>& roles = layout_.roles[field.type];
      bool has = false;
      for (std::size_t i = 0; i < roles.size() && !has; ++i)
        has = IsGoneInto(type.fields[i], roles[i]) && HasPoses(type.fields[i]);
      within = has ? 1 : 0;
    }
    return within == 1;
  }

  std::size_t AddPart(std::size_t type_index, const std::string& called, bool in_frame) {
    const std::size_t index = layout_.parts.size();
    const DefinedType& type = types_[type_index];
    const std::size_t of_fields = type_index + (in_frame ? types_.size() : 0);
    const std::vector<Role>& roles = layout_.roles[of_fields];
    layout_.parts.push_back({.type = type_index, .roles = of_fields});
    if (const Shape shape = ShapeOf(type_index, roles, called); shape != Shape::kNone) {
      layout_.parts[index].pose = static_cast<int>(layout_.fields.size());
      layout_.fields.push_back({.steps = steps_, .oriented = shape == Shape::kPose});
    }
    in_frame = in_frame || std::ranges::count(roles, Role::kHeader) > 0;
    for (std::size_t i = 0; i < roles.size() && layout_.fields.size() < kMostPoseFields; ++i) {
      const DefinedField& field = type.fields[i];
      if (!IsGoneInto(field, roles[i]) || !HasPoses(field)) continue;
      steps_.push_back({.field = field.name, .list = field.many != Many::kOne});
      const std::size_t part = AddPart(field.type, field.name, in_frame);
      steps_.pop_back();
      layout_.parts[index].children.push_back({.field = i, .part = part});
    }
    return index;
  }

  PoseLayout& layout_;
  const std::vector<DefinedType>& types_;
  std::vector<int> has_within_;  ///< poses, of each type; -1: not known yet
  std::vector<PoseField::Step> steps_;
};

/// "[Cup]" at the beginning of the text, which it takes away; brackets in names are in pairs.
std::optional<std::string> TakeKey(std::string_view& text) {
  int open = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    open += text[i] == '[' ? 1 : text[i] == ']' ? -1 : 0;
    if (open > 0) continue;
    std::string key(text.substr(1, i - 1));
    text.remove_prefix(i + 1);
    return key;
  }
  return std::nullopt;
}

bool IsMeant(const BodyAddress& address, const PoseField& field) {
  if (address.keys.size() != field.Lists()) return false;
  return address.steps.size() <= field.steps.size() &&
         std::equal(address.steps.begin(), address.steps.end(), field.steps.begin());
}

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

std::size_t PoseField::Lists() const {
  return static_cast<std::size_t>(std::ranges::count(steps, true, &Step::list));
}

std::vector<Role> RolesOfNumbers(const DefinedType& type) {
  std::vector<Role> roles;
  bool has_w = false;
  for (const DefinedField& field : type.fields) {
    roles.push_back(RoleOfNumber(field));
    has_w = has_w || (LowerCase(field.name) == "w" && IsReal(field) && field.many == Many::kOne);
  }
  if (!has_w) return roles;
  for (std::size_t i = 0; i < roles.size(); ++i) {  // a quaternion
    if (roles[i] == Role::kX) roles[i] = Role::kQx;
    if (roles[i] == Role::kY) roles[i] = Role::kQy;
    if (roles[i] == Role::kZ) roles[i] = Role::kQz;
    if (LowerCase(type.fields[i].name) == "w" && IsReal(type.fields[i])) roles[i] = Role::kQw;
  }
  return roles;
}

PoseLayout LayoutOf(MessageDefinition definition) {
  PoseLayout layout{.definition = std::move(definition)};
  LayoutMaker(layout).Make();
  return layout;
}

std::optional<BodyAddress> ParseBodyAddress(std::string_view text) {
  BodyAddress address;
  const bool has_path = text.starts_with(':');
  while (!text.empty()) {
    if (has_path) {
      if (text[0] != (address.steps.empty() ? ':' : '.')) return std::nullopt;
      text.remove_prefix(1);
      const std::size_t end = std::min(text.find_first_of(".["), text.size());
      if (end == 0) return std::nullopt;
      address.steps.push_back({.field = std::string(text.substr(0, end))});
      text.remove_prefix(end);
    }
    if (text.starts_with('[')) {
      std::optional<std::string> key = TakeKey(text);
      if (!key) return std::nullopt;
      address.keys.push_back(std::move(*key));
      if (has_path) address.steps.back().list = true;
    } else if (!has_path) {
      return std::nullopt;
    }
  }
  return address;
}

std::vector<std::size_t> FieldsOf(const BodyAddress& address,
                                  const std::vector<PoseField>& fields) {
  std::vector<std::size_t> meant;
  bool oriented = false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!IsMeant(address, fields[i])) continue;
    if (address.steps.size() == fields[i].steps.size()) return {i};  // its whole path
    meant.push_back(i);
    oriented = oriented || fields[i].oriented;
  }
  if (oriented) std::erase_if(meant, [&](std::size_t i) { return !fields[i].oriented; });
  return meant;
}

std::string AddressOf(const std::string& topic, const std::vector<PoseField>& fields,
                      std::size_t field, const std::vector<std::string>& keys) {
  BodyAddress address{.keys = keys};
  const std::vector<PoseField::Step>& steps = fields[field].steps;
  const std::vector<std::size_t> only = {field};
  // With a path, all lists are in it.
  const auto is_complete = [&] {
    const auto lists = std::ranges::count(address.steps, true, &PoseField::Step::list);
    const bool has_lists = address.steps.empty() || static_cast<std::size_t>(lists) == keys.size();
    return has_lists && FieldsOf(address, fields) == only;
  };
  while (!is_complete() && address.steps.size() < steps.size())
    address.steps.push_back(steps[address.steps.size()]);
  std::string text = topic;
  auto key = keys.begin();
  for (std::size_t i = 0; i < address.steps.size(); ++i) {
    text += (i == 0 ? ":" : ".") + address.steps[i].field;
    if (address.steps[i].list && key != keys.end()) text += "[" + *key++ + "]";
  }
  for (; key != keys.end(); ++key) text += "[" + *key + "]";
  return text;
}

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
  reader->is_drawn_ = type.starts_with("visualization_msgs/");
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

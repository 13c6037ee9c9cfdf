// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/messages/message_definition.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kMostFields = 5'000;  ///< of a definition
constexpr std::size_t kMostNested = 30;     ///< types, one in another
constexpr std::string_view kBlanks = " \t\r";

bool IsWord(std::string_view text, std::string_view besides = "") {
  const auto is_plain = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           besides.find(c) != std::string_view::npos;
  };
  return !text.empty() && std::ranges::all_of(text, is_plain) && (text[0] < '0' || text[0] > '9');
}

const std::map<std::string_view, Basic>& BasicTypes() {
  static const std::map<std::string_view, Basic> kTypes = {
      {"bool", Basic::kBool},       {"byte", Basic::kUint8},
      {"char", Basic::kUint8},      {"int8", Basic::kInt8},
      {"uint8", Basic::kUint8},     {"int16", Basic::kInt16},
      {"uint16", Basic::kUint16},   {"int32", Basic::kInt32},
      {"uint32", Basic::kUint32},   {"int64", Basic::kInt64},
      {"uint64", Basic::kUint64},   {"float32", Basic::kFloat32},
      {"float64", Basic::kFloat64}, {"time", Basic::kTime},
      {"duration", Basic::kTime},   {"builtin_interfaces/Time", Basic::kTime},
      {"string", Basic::kText},     {"builtin_interfaces/Duration", Basic::kTime},
      {"wstring", Basic::kWideText}};
  return kTypes;
}

/// A line of the text.
struct Line {
  int number = 0;
  std::string_view text;
};

class DefinitionReader {
 public:
  DefinitionReader(bool ros1, MessageDefinition& definition)
      : ros1_(ros1), definition_(definition) {}

  std::string Read(std::string_view type, std::string_view text) {
    Split(PlainTypeName(type), text);
    if (problem_.empty()) TypeOf(PlainTypeName(type), 0);
    return problem_;
  }

 private:
  void Fail(int line, std::string_view why) {
    if (!problem_.empty()) return;
    problem_ = line > 0 ? fmt::format("its definition, line {}: {}", line, why)
                        : fmt::format("its definition: {}", why);
  }

  /// Into the lines of each type.
  void Split(const std::string& type, std::string_view text) {
    std::vector<Line>* section = &sections_[type];
    bool after_separator = false;
    std::size_t fields = 0;
    int number = 0;
    for (const std::string_view whole : LinesOf(text)) {
      const std::string_view line = Trimmed(whole.substr(0, whole.find('#')), kBlanks);
      ++number;
      if (!problem_.empty()) return;
      if (line.empty()) continue;
      if (line.size() >= 3 && line.find_first_not_of('=') == std::string_view::npos) {
        after_separator = true;
      } else if (after_separator) {
        if (!line.starts_with("MSG:"))
          return Fail(number, fmt::format("expected 'MSG: ' and a type, found '{}'", Shown(line)));
        section = &sections_[PlainTypeName(Trimmed(line.substr(4), kBlanks))];
        after_separator = false;
        if (!section->empty()) section = &repeated_;
      } else if (++fields > kMostFields) {
        Fail(0, fmt::format("more than {} fields", kMostFields));
      } else {
        section->push_back({number, line});
      }
    }
    if (after_separator) Fail(0, "it is cut off: it ends before the next type");
  }

  static std::string Shown(std::string_view text) { return ReadableName(text.substr(0, 60)); }

  /// Which of the definition's types it is; reads it, and those in it.
  std::size_t TypeOf(const std::string& name, int line) {
    if (const auto known = indices_.find(name); known != indices_.end()) {
      if (open_.contains(name)) Fail(line, fmt::format("'{}' is in itself", Shown(name)));
      return known->second;
    }
    if (open_.size() >= kMostNested)
      Fail(line, fmt::format("more than {} types, one in another", kMostNested));
    if (!problem_.empty()) return 0;
    std::vector<Line> lines;
    const auto section = sections_.find(name);
    const std::string_view known = TextOfKnownType(name, ros1_);
    const bool has_text = section != sections_.end() && !section->second.empty();
    if (!has_text && !known.empty()) {
      for (const std::string_view one : LinesOf(known)) lines.push_back({line, one});
    } else if (section == sections_.end()) {
      Fail(line, fmt::format("no type '{}' is in it", Shown(name)));
      return 0;
    } else {
      lines = section->second;
    }
    const std::size_t index = definition_.types.size();
    indices_.emplace(name, index);
    definition_.types.push_back({.name = name});
    open_.insert(name);
    const std::string package = name.substr(0, name.find('/'));
    DefinedType type{.name = name};
    for (const Line& one : lines) TakeField(one, package, type);
    open_.erase(name);
    definition_.types[index] = std::move(type);
    return index;
  }

  void TakeField(const Line& line, const std::string& package, DefinedType& type) {
    const std::size_t blank = line.text.find_first_of(kBlanks);
    if (blank == std::string_view::npos)
      return Fail(line.number,
                  fmt::format("expected a type and a name, found '{}'", Shown(line.text)));
    const std::string_view rest = Trimmed(line.text.substr(blank), kBlanks);
    const std::string_view name = rest.substr(0, rest.find_first_of(" \t\r="));
    if (!IsWord(name))
      return Fail(line.number, fmt::format("expected a name, found '{}'", Shown(rest)));
    if (Trimmed(rest.substr(name.size()), kBlanks).starts_with('=')) return;  // a constant
    DefinedField field{.name = std::string(name)};
    std::string_view base = line.text.substr(0, blank);
    if (!TakeMany(base, field))
      return Fail(line.number,
                  fmt::format("expected a type, found '{}'", Shown(line.text.substr(0, blank))));
    SetBase(base, package, line.number, field);
    if (!problem_.empty()) return;
    AddSize(field, type);
    if (type.least_bytes > kMaxLogRecordBytes)
      return Fail(line.number, fmt::format("a message of more than {} MiB; no more are read",
                                           kMaxLogRecordBytes >> 20));
    type.fields.push_back(std::move(field));
  }

  /// What is in brackets, which it takes away.
  static bool TakeMany(std::string_view& base, DefinedField& field) {
    const std::size_t bracket = base.find('[');
    if (bracket == std::string_view::npos) return true;
    if (base.back() != ']') return false;
    std::string_view inside = base.substr(bracket + 1, base.size() - bracket - 2);
    base = base.substr(0, bracket);
    field.many = DefinedField::Many::kAny;
    const bool at_most = inside.starts_with("<=");
    if (at_most) inside.remove_prefix(2);
    if (inside.empty()) return !at_most;
    const auto [end, error] =
        std::from_chars(inside.data(), inside.data() + inside.size(), field.count);
    if (!at_most) field.many = DefinedField::Many::kFixed;
    return error == std::errc() && end == inside.data() + inside.size();
  }

  void SetBase(std::string_view base, const std::string& package, int line, DefinedField& field) {
    if (base.starts_with("string<=") || base.starts_with("wstring<="))
      base = base.substr(0, base.find('<'));
    std::string name = PlainTypeName(base);
    if (const auto basic = BasicTypes().find(name); basic != BasicTypes().end()) {
      field.basic = basic->second;
      return;
    }
    if (!IsWord(name, "/"))
      return Fail(line, fmt::format("expected a type, found '{}'", Shown(base)));
    if (name == "Header") name = "std_msgs/Header";
    if (name.find('/') == std::string::npos) name = package + "/" + name;
    field.type = TypeOf(name, line);
  }

  void AddSize(const DefinedField& field, DefinedType& type) const {
    std::uint64_t bytes = BytesOf(field.basic);
    if (field.basic == Basic::kText || field.basic == Basic::kWideText) type.same_size = false;
    if (field.basic == Basic::kMessage) {
      const DefinedType& inner = definition_.types[field.type];
      bytes = inner.least_bytes;
      type.same_size = type.same_size && inner.same_size;
    }
    if (field.many == DefinedField::Many::kFixed) bytes *= field.count;
    if (field.many == DefinedField::Many::kAny) {
      bytes = 4;
      type.same_size = false;
    }
    type.least_bytes += bytes;  // both are at most 2^58
  }

  const bool ros1_;
  MessageDefinition& definition_;
  std::map<std::string, std::vector<Line>> sections_;
  std::vector<Line> repeated_;
  std::map<std::string, std::size_t> indices_;
  std::set<std::string> open_;  ///< types that are being read
  std::string problem_;
};

}  // namespace

std::uint64_t BytesOf(Basic basic) {
  switch (basic) {
    case Basic::kBool:
    case Basic::kInt8:
    case Basic::kUint8:
      return 1;
    case Basic::kInt16:
    case Basic::kUint16:
      return 2;
    case Basic::kInt64:
    case Basic::kUint64:
    case Basic::kFloat64:
    case Basic::kTime:
      return 8;
    case Basic::kInt32:
    case Basic::kUint32:
    case Basic::kFloat32:
    case Basic::kText:
    case Basic::kWideText:
    case Basic::kMessage:
      break;  // of a text its length
  }
  return 4;
}

std::string PlainTypeName(std::string_view name) {
  std::string plain(name);
  if (const std::size_t at = plain.find("/msg/"); at != std::string::npos) plain.erase(at, 4);
  return plain;
}

std::string ReadDefinition(std::string_view type, std::string_view text, bool ros1,
                           MessageDefinition& definition) {
  return DefinitionReader(ros1, definition).Read(type, text);
}

std::string_view TextOfKnownType(std::string_view type, bool ros1) {
  if (type == "std_msgs/Header")
    return ros1 ? "uint32 seq\ntime stamp\nstring frame_id" : "time stamp\nstring frame_id";
  static const std::map<std::string_view, std::string_view> kTexts = {
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
      {"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
      {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation"},
      {"geometry_msgs/PoseStamped", "Header header\nPose pose"},
      {"geometry_msgs/PoseArray", "Header header\nPose[] poses"},
      {"geometry_msgs/TransformStamped",
       "Header header\nstring child_frame_id\nTransform transform"},
      {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"},
      {"geometry_msgs/PoseWithCovarianceStamped", "Header header\nPoseWithCovariance pose"},
      {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular"},
      {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance"},
      {"geometry_msgs/PointStamped", "Header header\nPoint point"},
      {"nav_msgs/Odometry",
       "Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist"},
      {"sensor_msgs/JointState",
       "Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort"},
      {"std_msgs/Float32", "float32 data"},
      {"std_msgs/Float64", "float64 data"},
      {"vision_msgs/ObjectHypothesis", "string class_id\nfloat64 score"},
      {"vision_msgs/ObjectHypothesisWithPose",
       "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose"},
      {"vision_msgs/BoundingBox3D", "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size"},
      {"vision_msgs/Detection3D",
       "Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\nstring id"},
      {"vision_msgs/Detection3DArray", "Header header\nDetection3D[] detections"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms"},
      {"tf/tfMessage", "geometry_msgs/TransformStamped[] transforms"}};
  const auto known = kTexts.find(type);
  return known == kTexts.end() ? std::string_view() : known->second;
}

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/messages/log_file.h"
#include "harness/exchange/messages/pose_fields.h"

namespace prehend::exchange {
namespace {

using Many = DefinedField::Many;

constexpr std::uint32_t kMostUnwanted = 200;  ///< poses of a message that nobody asked for
constexpr std::int64_t kNanosecondsOfSecond = 1'000'000'000;

/// What a part of a message says, and what counts for the poses in it.
struct Facts {
  std::optional<std::int64_t> stamp_ns;
  std::optional<std::string_view> frame;
  std::string_view name, other_name, child_frame, name_space;
  std::string ids;
  std::vector<std::string_view> names;
  bool tracked = true;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector4d xyzw = Eigen::Vector4d(0, 0, 0, 1);
};

/// A list whose elements have no names of their own.
struct Unnamed {
  std::size_t begin = 0, end = 0;  ///< the poses in it
  std::size_t count = 0;           ///< of elements
};

std::string ReadableBodyName(std::string_view name) {
  return ReadableName(name.substr(0, kMostBodyNameBytes));
}

/// "" if it has none.
std::string NameOf(const Facts& facts) {
  for (const std::string_view name : {facts.name, facts.other_name, facts.child_frame}) {
    if (!name.empty()) return ReadableBodyName(name);
  }
  if (facts.ids.empty() || facts.name_space.empty())
    return facts.ids.empty() ? ReadableBodyName(facts.name_space) : facts.ids;
  return ReadableBodyName(facts.name_space) + "/" + facts.ids;
}

/// Bytes of a message, by the definition of its type.
class MessageBytes {
 public:
  MessageBytes(const MessageDefinition& definition, bool ros1, std::string_view data)
      : definition_(definition), ros1_(ros1), reader_{.bytes = data} {}

 protected:
  bool Ok() const { return reader_.ok && problem_.empty(); }
  void Fail(std::string why) {
    if (Ok()) problem_ = std::move(why);
  }

  const DefinedType& TypeOf(std::size_t index) const { return definition_.types[index]; }

  /// Which byte is first, and how far numbers are aligned: RTPS 2.5, 10.2.
  void TakeEncapsulation() {
    const std::string_view head = reader_.Bytes(4);
    if (!reader_.ok) return;
    const auto kind = static_cast<unsigned char>(head[1]);
    const bool plain = head[0] == 0 && (kind <= 1 || kind == 6 || kind == 7);
    if (!plain)
      return Fail(fmt::format("CDR of the kind {:02x}{:02x}; 0000, 0001, 0006 and 0007 are read",
                              static_cast<unsigned char>(head[0]), kind));
    second_version_ = kind > 1;
    reader_ = {.bytes = reader_.bytes.substr(4),
               .big_endian = kind % 2 == 0,
               .most_alignment = std::size_t{kind <= 1 ? 8u : 4u}};
  }

  std::string_view TakeText() {
    std::string_view text = reader_.Text();
    if (!ros1_ && text.ends_with('\0')) text.remove_suffix(1);
    return text;
  }

  double TakeReal(Basic basic) {
    return basic == Basic::kFloat32 ? reader_.Number<float>() : reader_.Number<double>();
  }

  std::int64_t TakeTime() {
    const auto seconds = reader_.Number<std::uint32_t>();
    const auto nanoseconds = reader_.Number<std::uint32_t>();
    return seconds * kNanosecondsOfSecond + nanoseconds;
  }

  template <class T>
  std::string IntegerText() {
    return std::to_string(reader_.Number<T>());
  }

  std::string TakeInteger(Basic basic) {
    const bool is_signed = basic == Basic::kInt8 || basic == Basic::kInt16 ||
                           basic == Basic::kInt32 || basic == Basic::kInt64;
    const std::uint64_t bytes = BytesOf(basic);
    if (bytes == 1) return is_signed ? IntegerText<std::int8_t>() : IntegerText<std::uint8_t>();
    if (bytes == 2) return is_signed ? IntegerText<std::int16_t>() : IntegerText<std::uint16_t>();
    if (bytes == 4) return is_signed ? IntegerText<std::int32_t>() : IntegerText<std::uint32_t>();
    return is_signed ? IntegerText<std::int64_t>() : IntegerText<std::uint64_t>();
  }

  /// How many elements a field has; 0 after an error.
  std::uint32_t TakeCount(const DefinedField& field) {
    const bool inner = field.basic == Basic::kMessage;
    const bool with_size = inner || field.basic == Basic::kText || field.basic == Basic::kTime;
    if (second_version_ && with_size && field.many != Many::kOne) reader_.Number<std::uint32_t>();
    if (field.many != Many::kAny) return field.many == Many::kOne ? 1 : field.count;
    const auto count = reader_.Number<std::uint32_t>();
    std::uint64_t bytes = inner ? TypeOf(field.type).least_bytes : BytesOf(field.basic);
    if (!ros1_) bytes = std::max<std::uint64_t>(bytes, 1);
    if (count * bytes > reader_.left())
      Fail(fmt::format("it is cut off, or not of its type: '{}' has {} elements, in {} bytes",
                       field.name, count, reader_.left()));
    return Ok() ? count : 0;
  }

  void Skip(const DefinedField& field) {
    const std::uint32_t count = TakeCount(field);
    if (!Ok()) return;
    if (field.basic == Basic::kWideText)
      return Fail(fmt::format("'{}' is a wstring, which is not read", field.name));
    if (field.basic == Basic::kText) {
      for (std::uint32_t i = 0; i < count && Ok(); ++i) reader_.Text();
    } else if (field.basic != Basic::kMessage) {
      SkipNumbers(field.basic, count);
    } else if (const DefinedType& type = TypeOf(field.type); ros1_ && type.same_size) {
      reader_.Bytes(type.least_bytes * count);
    } else {
      for (std::uint32_t i = 0; i < count && Ok(); ++i) SkipMessage(type);
    }
  }

  void SkipNumbers(Basic basic, std::uint64_t count) {
    if (count == 0) return;
    const std::uint64_t bytes = BytesOf(basic);
    // The first one aligns those that follow.
    if (bytes == 2) reader_.Number<std::uint16_t>();
    if (bytes == 4 || basic == Basic::kTime) reader_.Number<std::uint32_t>();
    if (bytes == 8 && basic != Basic::kTime) reader_.Number<std::uint64_t>();
    const std::uint64_t taken = bytes == 1 ? 0 : basic == Basic::kTime ? 4 : bytes;
    reader_.Bytes(bytes * count - taken);
  }

  void SkipMessage(const DefinedType& type) {
    if (type.fields.empty()) return SkipNothing();
    for (const DefinedField& field : type.fields) {
      if (Ok()) Skip(field);
    }
  }

  /// In CDR, a message without fields has a byte.
  void SkipNothing() {
    if (!ros1_) reader_.Bytes(1);
  }

  void TakeHeader(const DefinedField& field, Facts& facts) {
    for (const DefinedField& inner : TypeOf(field.type).fields) {
      if (!Ok()) return;
      const bool one = inner.many == Many::kOne;
      if (one && inner.basic == Basic::kTime && inner.name == "stamp")
        facts.stamp_ns = TakeTime();
      else if (one && inner.basic == Basic::kText && inner.name == "frame_id")
        facts.frame = TakeText();
      else
        Skip(inner);
    }
  }

  const MessageDefinition& definition_;
  const bool ros1_;
  ByteReader reader_;
  bool second_version_ = false;  ///< of CDR
  std::string problem_;
};

/// One number of a message.
class NumberDecoder : public MessageBytes {
 public:
  NumberDecoder(const MessageDefinition& definition, bool ros1, std::string_view data,
                const BodyAddress& address)
      : MessageBytes(definition, ros1, data), address_(address) {}

  std::string Decode(std::vector<double>& numbers, std::optional<std::int64_t>& stamp_ns) {
    if (!ros1_) TakeEncapsulation();
    if (Ok()) TakeMessage(TypeOf(0), 0);
    if (problem_.empty() && !reader_.ok) return "it is cut off, or not of its type";
    stamp_ns = facts_.stamp_ns;
    if (!problem_.empty()) return problem_;
    std::size_t index = 0;
    if (!address_.keys.empty()) {
      const std::string& key = address_.keys.back();
      const auto name = std::ranges::find(facts_.names, key);
      const auto number = name != facts_.names.end()
                              ? static_cast<std::size_t>(name - facts_.names.begin())
                              : NumberFrom<std::size_t>(key);
      if (!number) return "";
      index = *number;
    } else if (found_.size() > 1) {
      return fmt::format("it has {} numbers there; TOPIC[NAME], or TOPIC[0], says which",
                         found_.size());
    }
    if (index < found_.size()) numbers.push_back(found_[index]);
    return "";
  }

 private:
  static bool IsNumber(const DefinedField& field) { return field.basic < Basic::kTime; }

  /// The field that is meant, if the address names none: the list "position", else the only number.
  std::string OnlyField(const DefinedType& type) const {
    std::string only;
    for (const DefinedField& field : type.fields) {
      if (field.name == "position" && IsNumber(field)) return field.name;
      if (!IsNumber(field)) continue;
      if (!only.empty()) return "";
      only = field.name;
    }
    return only;
  }

  void TakeMessage(const DefinedType& type, std::size_t depth) {
    const bool is_named = depth < address_.steps.size();
    const std::string wanted = is_named ? address_.steps[depth].field : OnlyField(type);
    const auto has = std::ranges::find(type.fields, wanted, &DefinedField::name);
    if (has == type.fields.end() ||
        (IsNumber(*has) ? depth + 1 < address_.steps.size()
                        : has->basic != Basic::kMessage || has->many != Many::kOne))
      return Fail(fmt::format("its type {} has no number '{}'; it has {}", type.name,
                              is_named ? wanted : "", FieldsOf(type)));
    for (const DefinedField& field : type.fields) {
      if (!Ok()) return;
      if (&field == &*has && IsNumber(field)) {
        const std::uint32_t count = TakeCount(field);
        for (std::uint32_t i = 0; i < count && Ok(); ++i) found_.push_back(TakeNumber(field.basic));
      } else if (&field == &*has) {
        TakeMessage(TypeOf(field.type), depth + 1);
      } else if (field.basic == Basic::kText && field.many == Many::kAny &&
                 field.name.find("name") != std::string::npos) {
        const std::uint32_t count = TakeCount(field);
        for (std::uint32_t i = 0; i < count && Ok(); ++i) facts_.names.push_back(TakeText());
      } else if (field.basic == Basic::kMessage && field.many == Many::kOne &&
                 TypeOf(field.type).name == "std_msgs/Header") {
        TakeHeader(field, facts_);
      } else {
        Skip(field);
      }
    }
  }

  double TakeNumber(Basic basic) {
    if (basic == Basic::kFloat32 || basic == Basic::kFloat64) return TakeReal(basic);
    return basic == Basic::kBool ? reader_.Number<std::uint8_t>() : std::stod(TakeInteger(basic));
  }

  static std::string FieldsOf(const DefinedType& type) {
    std::string all;
    for (const DefinedField& field : type.fields)
      if (IsNumber(field) || field.basic == Basic::kMessage)
        all += (all.empty() ? "" : ", ") + field.name;
    return all.empty() ? "none" : all;
  }

  const BodyAddress& address_;
  Facts facts_;
  std::vector<double> found_;
};

class BinaryDecoder : public MessageBytes {
 public:
  BinaryDecoder(const PoseLayout& layout, bool ros1, std::string_view data,
                const std::vector<bool>& wanted, std::vector<MessagePose>& poses)
      : MessageBytes(layout.definition, ros1, data),
        layout_(layout),
        wanted_(wanted),
        poses_(poses) {}

  std::string Decode() {
    if (!ros1_) TakeEncapsulation();
    Facts facts;
    if (Ok()) TakePart(0, facts);
    if (problem_.empty() && !reader_.ok) return "it is cut off, or not of its type";
    if (problem_.empty() && reader_.left() > 7)
      return fmt::format("{} bytes too many for its type", reader_.left());
    return problem_;
  }

 private:
  /// Fields x, y, z and w, or an array in this order.
  void TakeNumbers(const DefinedField& field, Facts& facts, bool orientation) {
    if (field.basic != Basic::kMessage) {
      if (TakeCount(field) == 0) return;
      for (int i = 0; i < (orientation ? 4 : 3); ++i)
        (orientation ? facts.xyzw[i] : facts.p[i]) = TakeReal(field.basic);
      return;
    }
    const DefinedType& type = TypeOf(field.type);
    const std::vector<Role>& roles = NumbersOf(field.type);
    for (std::size_t i = 0; i < type.fields.size() && Ok(); ++i)
      TakeField(type.fields[i], roles[i], facts);
  }

  const std::vector<Role>& NumbersOf(std::size_t type) {
    for (const auto& [known, roles] : numbers_) {
      if (known == type) return roles;
    }
    return numbers_.emplace_back(type, RolesOfNumbers(TypeOf(type))).second;
  }

  void TakeField(const DefinedField& field, Role role, Facts& facts) {
    switch (role) {
      case Role::kNothing:
        return Skip(field);
      case Role::kHeader:
        return TakeHeader(field, facts);
      case Role::kStamp:
        facts.stamp_ns = TakeTime();
        return;
      case Role::kFrame:
        facts.frame = TakeText();
        return;
      case Role::kName:
        facts.name = TakeText();
        return;
      case Role::kOtherName: {
        const std::string_view name = TakeText();
        if (facts.other_name.empty()) facts.other_name = name;
        return;
      }
      case Role::kChildFrame:
        facts.child_frame = TakeText();
        return;
      case Role::kNamespace:
        facts.name_space = TakeText();
        return;
      case Role::kId:
        facts.ids += (facts.ids.empty() ? "" : "/") + TakeInteger(field.basic);
        return;
      case Role::kNames: {
        const std::uint32_t count = TakeCount(field);
        for (std::uint32_t i = 0; i < count && Ok(); ++i) facts.names.push_back(TakeText());
        return;
      }
      case Role::kTracked:
      case Role::kNotTracked:
        if ((reader_.Number<std::uint8_t>() != 0) != (role == Role::kTracked))
          facts.tracked = false;
        return;
      case Role::kPosition:
      case Role::kOrientation:
        return TakeNumbers(field, facts, role == Role::kOrientation);
      case Role::kX:
      case Role::kY:
      case Role::kZ:
        facts.p[static_cast<int>(role) - static_cast<int>(Role::kX)] = TakeReal(field.basic);
        return;
      case Role::kQx:
      case Role::kQy:
      case Role::kQz:
      case Role::kQw:
        facts.xyzw[static_cast<int>(role) - static_cast<int>(Role::kQx)] = TakeReal(field.basic);
    }
  }

  void TakePart(std::size_t index, Facts& facts) {
    const PoseLayout::Part& part = layout_.parts[index];
    const DefinedType& type = TypeOf(part.type);
    const std::size_t begin = poses_.size();
    std::vector<Unnamed> unnamed;
    auto child = part.children.begin();
    if (type.fields.empty()) SkipNothing();
    for (std::size_t i = 0; i < type.fields.size() && Ok(); ++i) {
      if (child == part.children.end() || child->field != i)
        TakeField(type.fields[i], layout_.roles[part.roles][i], facts);
      else
        TakeParts(type.fields[i], (child++)->part, unnamed);
    }
    if (!Ok()) return;
    if (part.pose >= 0) AddPose(static_cast<std::size_t>(part.pose), facts);
    for (const Unnamed& list : unnamed) {
      if (list.count == facts.names.size()) NameElements(list, facts.names);
    }
    for (std::size_t i = begin; i < poses_.size(); ++i) {
      MessagePose& pose = poses_[i];
      if (!pose.stamp_ns) pose.stamp_ns = facts.stamp_ns;
      if (facts.frame && pose.frame.empty()) pose.frame = ReadableBodyName(*facts.frame);
      if (pose.name.empty()) pose.name = ReadableBodyName(facts.child_frame);
      pose.missing = pose.missing || !facts.tracked;
    }
  }

  void TakeParts(const DefinedField& field, std::size_t part, std::vector<Unnamed>& unnamed) {
    const std::uint32_t count = TakeCount(field);
    Unnamed list{.begin = poses_.size(), .end = 0, .count = count};
    bool has_names = false;
    for (std::uint32_t i = 0; i < count && Ok(); ++i) {
      const std::size_t begin = poses_.size();
      Facts facts;
      TakePart(part, facts);
      if (field.many == Many::kOne || begin == poses_.size()) continue;
      std::string key = NameOf(facts);
      has_names = has_names || !key.empty();
      if (key.empty()) key = std::to_string(i);
      for (std::size_t k = begin; k < poses_.size(); ++k)
        poses_[k].keys.insert(poses_[k].keys.begin(), key);
    }
    list.end = poses_.size();
    if (field.many != Many::kOne && !has_names) unnamed.push_back(list);
  }

  /// By the texts in the list beside them.
  void NameElements(const Unnamed& list, const std::vector<std::string_view>& names) {
    for (std::size_t i = list.begin; i < list.end; ++i) {
      std::string& key = poses_[i].keys.front();
      const std::string_view name = names[std::stoul(key)];
      if (!name.empty()) key = ReadableBodyName(name);
    }
  }

  void AddPose(std::size_t field, const Facts& facts) {
    if (!wanted_[field] && ++unwanted_ > kMostUnwanted) return;
    if (wanted_[field] && ++wanted_count_ > kMostPosesOfMessage)
      return Fail(fmt::format("more than {} poses", kMostPosesOfMessage));
    MessagePose& pose = poses_.emplace_back();
    pose.field = field;
    pose.oriented = layout_.fields[field].oriented;
    pose.p = facts.p;
    pose.xyzw = facts.xyzw;
  }

  const PoseLayout& layout_;
  const std::vector<bool>& wanted_;
  std::vector<MessagePose>& poses_;
  std::uint32_t unwanted_ = 0, wanted_count_ = 0;
  std::vector<std::pair<std::size_t, std::vector<Role>>> numbers_;  ///< of types
};

}  // namespace

std::string DecodeBinaryNumber(const MessageDefinition& definition, bool ros1,
                               std::string_view data, const BodyAddress& address,
                               std::vector<double>& numbers,
                               std::optional<std::int64_t>& stamp_ns) {
  return NumberDecoder(definition, ros1, data, address).Decode(numbers, stamp_ns);
}

std::string DecodeBinaryPoses(const PoseLayout& layout, bool ros1, std::string_view data,
                              const std::vector<bool>& wanted, std::vector<MessagePose>& poses) {
  return BinaryDecoder(layout, ros1, data, wanted, poses).Decode();
}

}  // namespace prehend::exchange

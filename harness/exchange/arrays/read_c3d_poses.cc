// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/arrays/read_array_poses.h. C3D (https://www.c3d.org) has points and their
// labels, in integers or floating point, of Intel, MIPS and DEC processors: bodies without
// orientation, or markers of bodies. Analog channels, forces and events are not read. Tested by
// tests/program/import_markers.py
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/exchange/arrays/read_array_poses.h"
#include "harness/exchange/poses/pose_file.h"
#include "harness/exchange/poses/table_layout.h"
#include "harness/scenario/motion/read_bvh.h"

namespace prehend::exchange {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::size_t kMostNumbers = 16'000'000;  ///< of points, in all frames
constexpr std::size_t kEventsKey = 149;  ///< the word of the header that says it has events
constexpr std::uint16_t kHasEvents = 12345;

std::string Trimmed(std::string text) {
  text.resize(std::min(text.find('\0'), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  return ReadableName(text);
}

class C3dFile {
 public:
  std::vector<std::string> labels;  ///< of each point; "*17": it has none
  std::size_t frames = 0;
  double rate_hz = 0;
  std::string unit;                ///< "mm"; "": not said
  std::vector<std::string> notes;  ///< what is not read

  /// Takes the whole file. Returns what is wrong, with the byte at which it was seen, or "".
  std::string Load(std::string bytes) {
    bytes_ = std::move(bytes);
    if (bytes_.size() < 2 * kBlock || bytes_[1] != 0x50)
      return "at byte 1: it is no C3D file: its second byte is not 0x50";
    const std::size_t parameters_at = kBlock * (static_cast<unsigned char>(bytes_[0]) - 1u);
    if (bytes_[0] == 0 || parameters_at + kBlock > bytes_.size())
      return "at byte 0: its parameters would begin behind its end: is it cut off?";
    const auto code = static_cast<unsigned char>(bytes_[parameters_at + 3]);
    if (code < 84 || code > 86)
      return fmt::format(
          "at byte {}: it is of the processor {}; 84 (Intel), 85 (DEC) and 86 (MIPS) are read",
          parameters_at + 3, code);
    processor_ = static_cast<Processor>(code);
    const std::size_t blocks = static_cast<unsigned char>(bytes_[parameters_at + 2]);
    const std::size_t end =
        std::min(bytes_.size(), parameters_at + kBlock * std::max<std::size_t>(blocks, 1));
    if (std::string why = LoadParameters(parameters_at + 4, end); !why.empty()) return why;
    points_ = static_cast<std::size_t>(std::clamp(NumberOf("POINT:USED", Word(2)), 0.0, 65535.0));
    scale_ = NumberOf("POINT:SCALE", Real(12));
    is_real_ = scale_ < 0;
    rate_hz = NumberOf("POINT:RATE", Real(20));
    if (!(rate_hz > 0) || !std::isfinite(rate_hz)) rate_hz = Real(20);
    data_at_ = kBlock * (std::max<std::size_t>(Word(16), 1) - 1);
    frame_bytes_ = (std::size_t{4} * points_ + Word(4)) * (is_real_ ? 4 : 2);
    if (points_ == 0) return "it has no points: no markers";
    if (!std::isfinite(scale_) || (!is_real_ && scale_ == 0))
      return fmt::format("at byte 12: its points are scaled by {}", scale_);
    const std::set<std::size_t> said = FramesSaid();
    const std::size_t until = parameters_at > data_at_ ? parameters_at : bytes_.size(),
                      room = (until - std::min(until, data_at_)) / frame_bytes_;
    if (data_at_ < kBlock || (!said.empty() && room < *said.begin()))
      return fmt::format("at byte {}: it is cut off: {} frames of {} bytes are said, {} are there",
                         data_at_, said.empty() ? 0 : *said.begin(), frame_bytes_, room);
    frames = FramesThere(said, room);
    if (frames * points_ > kMostNumbers / 3)
      return fmt::format("{} frames of {} points; at most {} numbers are read", frames, points_,
                         kMostNumbers);
    if (std::string doubt = CountDoubt(said, frames); !doubt.empty()) notes.push_back(doubt);
    if (Real(20) > 0 && std::abs(rate_hz / Real(20) - 1) > 1e-3)
      notes.push_back(fmt::format("the head says {:g} and {:g} frames a second: the first counts",
                                  rate_hz, Real(20)));
    TakeLabels(points_);
    if (const auto units = parameters_.find("POINT:UNITS");
        units != parameters_.end() && !units->second.texts.empty())
      unit = units->second.texts.front();
    if (Word(4) > 0) notes.push_back(fmt::format("{} analog values a frame are not read", Word(4)));
    if (Word(2 * kEventsKey) == kHasEvents || NumberOf("EVENT:USED", 0) > 0)
      notes.emplace_back("its events are not read: score takes labels from a file of their own");
    return "";
  }

  /// None: not seen.
  std::optional<Eigen::Vector3d> At(std::size_t frame, std::size_t point) const {
    const std::size_t size = is_real_ ? 4 : 2,
                      at = data_at_ + frame * frame_bytes_ + point * 4 * size;
    Eigen::Vector3d p;
    for (int i = 0; i < 3; ++i) {
      const std::size_t place = at + static_cast<std::size_t>(i) * size;
      p[i] = is_real_ ? Real(place) : static_cast<std::int16_t>(Word(place)) * scale_;
    }
    const double residual =
        is_real_ ? Real(at + 12) : static_cast<double>(static_cast<std::int16_t>(Word(at + 6)));
    if (residual < 0 || !p.allFinite()) return std::nullopt;
    return p;
  }

 private:
  enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };
  /// A value of the parameter section: numbers, or texts.
  struct Parameter {
    std::vector<double> numbers;
    std::vector<std::string> texts;
  };

  std::uint16_t Word(std::size_t at) const {
    const auto first = static_cast<unsigned char>(bytes_[at]),
               second = static_cast<unsigned char>(bytes_[at + 1]);
    return static_cast<std::uint16_t>(processor_ == Processor::kMips ? first << 8 | second
                                                                     : second << 8 | first);
  }

  double Real(std::size_t at) const {
    const std::uint32_t first = Word(at), second = Word(at + 2);
    // DEC's words stand the other way round, and its exponent is 2 more.
    const bool is_low_first = processor_ == Processor::kIntel;
    const auto bits = is_low_first ? second << 16 | first : first << 16 | second;
    return std::bit_cast<float>(bits) * (processor_ == Processor::kDec ? 0.25 : 1.0);
  }

  std::string LoadParameters(std::size_t at, std::size_t end) {
    std::map<int, std::string> groups;
    std::vector<std::pair<std::string, std::pair<int, std::size_t>>> found;
    while (at + 2 <= end) {
      const std::size_t begin = at;
      const auto length = static_cast<std::size_t>(std::abs(static_cast<signed char>(bytes_[at])));
      const int group = static_cast<signed char>(bytes_[at + 1]);
      if (length == 0 || group == 0) break;
      if (at + 4 + length > end)
        return fmt::format("at byte {}: a parameter that ends behind its section", begin);
      std::string name = bytes_.substr(at + 2, length);
      std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
      at += 2 + length;
      const std::size_t next = Word(at);
      if (group < 0)
        groups[-group] = name;
      else
        found.push_back({name, {group, at + 2}});
      if (next == 0) break;
      if (next < 2) return fmt::format("at byte {}: a parameter that is followed by itself", begin);
      at += next;
    }
    for (const auto& [name, place] : found)
      if (std::string why = TakeParameter(groups[place.first] + ":" + name, place.second, end);
          !why.empty())
        return why;
    return "";
  }

  std::string TakeParameter(const std::string& name, std::size_t at, std::size_t end) {
    if (!name.starts_with("POINT:") && !name.starts_with("TRIAL:") && name != "EVENT:USED")
      return "";
    const std::string cut =
        fmt::format("at byte {}: the parameter {} ends behind its section", at, ReadableName(name));
    if (at + 2 > end) return cut;
    const int kind = static_cast<signed char>(bytes_[at]);
    const auto width = static_cast<std::size_t>(std::abs(kind));
    const std::size_t dimensions = static_cast<unsigned char>(bytes_[at + 1]);
    if ((width != 1 && width != 2 && width != 4) || dimensions > 7)
      return fmt::format("at byte {}: the parameter {} is of the kind {}, with {} dimensions", at,
                         ReadableName(name), kind, dimensions);
    at += 2 + dimensions;
    if (at > end) return cut;
    std::size_t count = 1;
    for (std::size_t i = 0; i < dimensions; ++i) {
      count *= static_cast<unsigned char>(bytes_[at - dimensions + i]);
      if (count * width > end - at) return cut;
    }
    if (count * width > end - at) return cut;
    Parameter& parameter = parameters_[name];
    if (kind == -1) {
      const std::size_t each =
          dimensions == 0 ? 1 : static_cast<unsigned char>(bytes_[at - dimensions]);
      for (std::size_t i = 0; each > 0 && i + each <= count; i += each)
        parameter.texts.push_back(Trimmed(bytes_.substr(at + i, each)));
      return "";
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t place = at + i * width;
      parameter.numbers.push_back(
          width == 4   ? Real(place)
          : width == 2 ? static_cast<double>(static_cast<std::int16_t>(Word(place)))
                       : static_cast<double>(static_cast<unsigned char>(bytes_[place])));
    }
    return "";
  }

  double NumberOf(const std::string& parameter, double otherwise) const {
    const auto found = parameters_.find(parameter);
    if (found == parameters_.end() || found->second.numbers.empty()) return otherwise;
    const double value = found->second.numbers.front();
    // Counts are written as if they had no sign.
    return value < 0 && parameter.ends_with(":USED") ? value + 65536 : value;
  }

  void TakeLabels(std::size_t points) {
    for (int i = 1;; ++i) {
      const auto found =
          parameters_.find(i == 1 ? "POINT:LABELS" : fmt::format("POINT:LABELS{}", i));
      if (found == parameters_.end()) break;
      labels.insert(labels.end(), found->second.texts.begin(), found->second.texts.end());
    }
    labels.resize(points);
    for (std::size_t i = 0; i < points; ++i)
      if (labels[i].empty()) labels[i] = fmt::format("*{}", i + 1);
  }

  /// The header counts to 65,535; of longer files other places say it.
  std::set<std::size_t> FramesSaid() const {
    const std::size_t first = Word(6), last = Word(8);
    const auto field = [&](const char* name) -> std::size_t {
      const auto found = parameters_.find(name);
      if (found == parameters_.end() || found->second.numbers.size() < 2) return 0;
      const auto word = [](double v) { return static_cast<std::size_t>(v < 0 ? v + 65536 : v); };
      return word(found->second.numbers[0]) + 65536 * word(found->second.numbers[1]);
    };
    const std::size_t begin = field("TRIAL:ACTUAL_START_FIELD"),
                      end = field("TRIAL:ACTUAL_END_FIELD");
    const double many = NumberOf("POINT:LONG_FRAMES", 0), few = NumberOf("POINT:FRAMES", 0);
    std::set<std::size_t> said;
    if (begin > 0 && end >= begin)
      said.insert(end - begin + 1);
    else if (many >= 1 && many < 1e9)
      said.insert(static_cast<std::size_t>(many));
    if (!said.empty() && *said.begin() > 65535) return said;
    if (few != 0 && few != 65535 && few != -1 && std::abs(few) < 1e9)
      said.insert(static_cast<std::size_t>(few < 0 ? few + 65536 : few));
    if (last >= first && (last != 65535 || said.empty())) said.insert(last - first + 1);
    return said;
  }

  /// The most that are said and are there; and what follows, but for zeros that fill a block.
  std::size_t FramesThere(const std::set<std::size_t>& said, std::size_t room) const {
    std::size_t there = 0;
    for (const std::size_t count : said)
      if (count <= room) there = count;
    if ((room - there) * frame_bytes_ < kBlock) return there;
    const auto is_empty = [&](std::size_t frame) {
      return std::string_view(bytes_)
                 .substr(data_at_ + frame * frame_bytes_, frame_bytes_)
                 .find_first_not_of('\0') == std::string_view::npos;
    };
    while (room > there && is_empty(room - 1)) --room;
    return room;
  }

  std::string bytes_;
  Processor processor_ = Processor::kIntel;
  std::map<std::string, Parameter> parameters_;  ///< "POINT:LABELS"
  std::size_t data_at_ = 0, frame_bytes_ = 0, points_ = 0;
  double scale_ = 1;
  bool is_real_ = false;
};

/// Its positions, of a body or a marker of the map.
void TakePoint(const C3dFile& file, const Located<std::string>& from, const ImportMap& map,
               PoseBody& body, DiagnosticList& errors) {
  const auto label = std::ranges::find(file.labels, from.value);
  if (label == file.labels.end())
    return errors.AddUnknownName(from.where, fmt::format("no point is called '{}'", from.value),
                                 from.value, file.labels);
  if (std::ranges::count(file.labels, from.value) > 1)
    return errors.Add(from.where, fmt::format("several points are called '{}'", from.value));
  const auto point = static_cast<std::size_t>(label - file.labels.begin());
  for (std::size_t i = 0; i < file.frames; ++i) {
    const auto at = file.At(i, point);
    if (at && !(map.zero_is_missing && at->isZero(0)))
      body.samples.push_back({.t_s = static_cast<double>(i) / map.rate_hz->value, .p = *at});
  }
}

Result<C3dFile> LoadC3d(const std::string& path) {
  PREHEND_TRY(std::string bytes, ReadBytes(path));
  C3dFile file;
  if (const std::string why = file.Load(std::move(bytes)); !why.empty())
    return tl::unexpected(ErrorOfFile(path, why));
  return file;
}

// Poses of joints, from a BVH file: the skeleton's forward kinematics. Tested by
// tests/program/import_bvh_test.cc

/// A minute of 200 joints at 120 Hz is 40 MB.
constexpr scenario::BvhLimits kLimits = {.frames = 500'000, .bytes = std::size_t{256} << 20};

/// The joint whose name, in small letters, ends with one of these words; -1 if there is none.
int JointCalled(const scenario::BvhFile& bvh, std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words) {
    for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
      if (LowerCase(bvh.joints[i].name).ends_with(word)) return static_cast<int>(i);
    }
  }
  return -1;
}

/// From a foot to the head, halfway through the file.
std::optional<Eigen::Vector3d> StatureOf(const scenario::BvhFile& bvh) {
  const int head = JointCalled(bvh, {"head"}),
            foot = JointCalled(bvh, {"foot", "ankle", "foot.l", "foot_l"});
  if (head < 0 || foot < 0) return std::nullopt;
  const std::vector<scenario::JointPose> poses = scenario::JointPosesAt(bvh, bvh.rows.size() / 2);
  return poses[static_cast<std::size_t>(head)].p - poses[static_cast<std::size_t>(foot)].p;
}

}  // namespace

Result<TableLayout> LayoutOfC3d(const std::string& path) {
  PREHEND_TRY(const C3dFile file, LoadC3d(path));
  TableLayout layout{.name = "a C3D file", .unit = UnitCalled(file.unit)};
  if (file.rate_hz > 0) layout.rate_hz = file.rate_hz;
  return layout;
}

Result<PoseFile> ReadC3dPoses(const std::string& path, const MapFile& map) {
  PREHEND_TRY(const C3dFile file, LoadC3d(path));
  DiagnosticList errors(map.document);
  if (!map.map.rate_hz)
    errors.Add(map.document.root.where, "'rate_hz' is missing: the file does not say it");
  PoseFile poses{.file = path, .bodies = BodiesOf(map.map, errors), .markers = MarkersOf(map.map)};
  poses.has_orientations = false;
  poses.rows = file.frames;
  for (const Named<MappedEntity>& entity : map.map.entities) {
    if (!errors.empty()) break;
    if (entity.value.from && entity.value.markers.empty())
      TakePoint(file, *entity.value.from, map.map,
                *std::ranges::find(poses.bodies, entity.value.from->value, &PoseBody::name),
                errors);
    for (const Located<std::string>& marker : entity.value.markers) {
      PoseBody& body = *std::ranges::find(poses.markers, marker.value, &PoseBody::name);
      if (body.samples.empty()) TakePoint(file, marker, map.map, body, errors);
    }
  }
  if (errors.empty()) {
    poses.last_s = static_cast<double>(file.frames - 1) / map.map.rate_hz->value;
    poses.notes = file.notes;
    const auto is_asked = [&](const std::string& label) {
      return std::ranges::find(poses.bodies, label, &PoseBody::name) != poses.bodies.end() ||
             std::ranges::find(poses.markers, label, &PoseBody::name) != poses.markers.end();
    };
    for (const std::string& label : file.labels)
      if (!is_asked(label) && !label.starts_with('*')) poses.unused.push_back(label);
    ComposeMarkers(map.map, poses, errors);
  }
  if (errors.empty()) RefuseAbsentBodies(poses, map.map, errors);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return poses;
}

Result<PoseFile> ReadBvhPoses(const std::string& path, const MapFile& map) {
  PREHEND_TRY(const scenario::BvhFile bvh, scenario::ReadBvh(path, kLimits));
  DiagnosticList errors(map.document);
  PoseFile poses{
      .file = path, .text = {}, .bodies = BodiesOf(map.map, errors), .unused = {}, .notes = {}};
  std::map<std::string, std::size_t> joints;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
    if (bvh.joints[i].name.empty()) continue;
    joints.emplace(bvh.joints[i].name, i);
    names.push_back(bvh.joints[i].name);
  }
  for (const Named<MappedEntity>& entity : map.map.entities) {
    const auto& from = entity.value.from;
    if (from && !joints.contains(from->value))
      errors.AddUnknownName(from->where, fmt::format("no joint is called '{}'", from->value),
                            from->value, names);
  }
  if (!errors.empty()) return tl::unexpected(errors.Sorted());

  if (map.map.is_draft) poses.unused = names;
  poses.stature = StatureOf(bvh);
  poses.rows = bvh.rows.size();
  poses.last_s = static_cast<double>(bvh.rows.size() - 1) * bvh.frame_time_s;
  for (std::size_t frame = 0; frame < bvh.rows.size(); ++frame) {
    const std::vector<scenario::JointPose> all = scenario::JointPosesAt(bvh, frame);
    for (PoseBody& body : poses.bodies) {
      const scenario::JointPose& joint = all[joints.at(body.name)];
      if (map.map.zero_is_missing && joint.p.isZero(0)) continue;
      body.samples.push_back({.t_s = static_cast<double>(frame) * bvh.frame_time_s,
                              .p = joint.p,
                              .q = joint.q,
                              .line = bvh.places[frame].line});
    }
  }
  RefuseAbsentBodies(poses, map.map, errors);
  if (!errors.empty()) return tl::unexpected(errors.Sorted());
  return poses;
}

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
// Reads the motion of a hand from CSV. Written here, although libcsv exists: the separators are the
// small part; units in the heads and errors with line and column are the large one. Tested by
// tests/harness/scenario/motion/hand_motion_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "harness/base/base/number_text.h"
#include "harness/base/base/text_file.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/motion/body_motion.h"

namespace prehend::scenario {
namespace {

using grammar::Diagnostics;
using grammar::Place;

constexpr std::size_t kMaxReportedLines = 20;
constexpr double kUnitTolerance = 0.01;  // two written digits

/// A column of the header: which quantity it holds, and what to multiply with to get SI units.
struct Column {
  std::string quantity;
  double scale = 1;
};

const std::map<std::string, Column>& KnownColumns() {
  static const std::map<std::string, Column> columns = [] {
    std::map<std::string, Column> all = {{"t_s", {"t", 1}}, {"t_ms", {"t", 1e-3}}};
    for (const std::string axis : {"x", "y", "z"}) {
      all[axis + "_m"] = {axis, 1};
      all[axis + "_cm"] = {axis, 1e-2};
      all[axis + "_mm"] = {axis, 1e-3};
    }
    for (const std::string angle : {"roll", "pitch", "yaw"}) {
      all[angle + "_deg"] = {angle, 1};
      all[angle + "_rad"] = {angle, 180 / std::numbers::pi};
    }
    for (const char* plain : {"qw", "qx", "qy", "qz", "trigger"}) all[plain] = {plain, 1};
    return all;
  }();
  return columns;
}

struct Cell {
  std::string_view text;
  int column = 1;  ///< in bytes, from 1
};

std::vector<Cell> Cells(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::size_t first = line.find_first_not_of(" \t", begin);
    first = std::min(first, end);
    std::size_t last = end;
    while (last > first && (line[last - 1] == ' ' || line[last - 1] == '\t')) --last;
    cells.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    begin = end + 1;
  }
  return cells;
}

/// The hint for an unknown column.
std::string ColumnRemedy(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [known, column] : KnownColumns()) names.push_back(known);
  const std::string nearest = grammar::NearestName(name, names);
  std::erase_if(names, [&](const std::string& known) { return !known.starts_with(name + "_"); });
  if (!name.empty() && !names.empty())
    return fmt::format(
        "did you mean '{}'?",
        *std::ranges::min_element(names, {}, [](const auto& n) { return n.size(); }));
  if (!nearest.empty()) return fmt::format("did you mean '{}'?", nearest);
  if (name.empty()) return "a comma too many";
  if (name.find_first_of(";\t") != std::string::npos) return "commas separate columns and values";
  if (name.front() == '"') return "names and values have no quotes";
  return "the header is like t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger";
}

class CsvReader {
 public:
  CsvReader(const std::string& path, std::string text) {
    track.file = path;
    track.text = std::move(text);
  }

  void Read() {
    for (const std::string_view line : LinesOf(track.text)) {
      if (diagnostics.size() >= kMaxReportedLines) return;
      ++line_;
      TakeLine(line);
      if (header_ && columns_.empty()) return;  // rows have no meaning without it
    }
    if (!diagnostics.empty()) return;
    if (track.samples.size() < 2)
      Complain({line_, 1}, fmt::format("{} row{}; a motion has at least 2", track.samples.size(),
                                       track.samples.size() == 1 ? "" : "s"));
  }

  MotionTrack track;
  Diagnostics diagnostics;

 private:
  void Complain(Place place, std::string message, std::string hint = {}) {
    if (diagnostics.size() >= grammar::kMostDiagnostics) return;
    diagnostics.push_back(
        grammar::DiagnosticAt(track.file, track.text, place, std::move(message), std::move(hint)));
  }

  void TakeLine(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos || line[first] == '#') return;
    if (header_) return TakeRow(Cells(line));
    header_ = true;
    TakeHeader(Cells(line));
  }

  void TakeHeader(const std::vector<Cell>& cells) {
    std::map<std::string, int> seen;
    std::vector<Column> columns;
    for (const Cell& cell : cells) {
      const std::string name(cell.text);
      const auto known = KnownColumns().find(name);
      if (known == KnownColumns().end()) {
        Complain({line_, cell.column}, fmt::format("'{}' is no column of a motion", name),
                 ColumnRemedy(name));
        continue;
      }
      if (++seen[known->second.quantity] > 1)
        Complain({line_, cell.column}, fmt::format("'{}' is given twice", known->second.quantity));
      columns.push_back(known->second);
    }
    if (!diagnostics.empty()) return;
    CheckColumns(seen);
    if (diagnostics.empty()) columns_ = std::move(columns);
  }

  void CheckColumns(const std::map<std::string, int>& seen) {
    const auto count = [&](std::initializer_list<const char*> names) {
      return std::count_if(names.begin(), names.end(),
                           [&](const char* n) { return seen.contains(n); });
    };
    const auto quaternion = count({"qw", "qx", "qy", "qz"}),
               angles = count({"roll", "pitch", "yaw"});
    const auto missing = [&](std::initializer_list<const char*> names) {
      std::vector<std::string> all;
      for (const char* name : names) {
        if (!seen.contains(name)) all.push_back(name);
      }
      return fmt::format("{}", fmt::join(all, ", "));
    };
    if (count({"t", "x", "y", "z"}) < 4)
      Complain({line_, 1},
               "the header needs t_s (or t_ms), x_m, y_m and z_m (or _cm, _mm); missing: " +
                   missing({"t", "x", "y", "z"}));
    if (quaternion > 0 && angles > 0)
      Complain({line_, 1}, "an orientation is either qw,qx,qy,qz or roll_deg,pitch_deg,yaw_deg");
    else if (quaternion % 4 != 0)
      Complain({line_, 1}, "a quaternion needs qw, qx, qy and qz; missing: " +
                               missing({"qw", "qx", "qy", "qz"}));
    has_quaternion_ = quaternion == 4;
  }

  void TakeRow(const std::vector<Cell>& cells) {
    if (cells.size() != columns_.size()) {
      return Complain({line_, cells.back().column},
                      fmt::format("expected {} values as in the header, found {}", columns_.size(),
                                  cells.size()));
    }
    std::map<std::string, double> row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = Number(cells[i]);
      if (!value) return;
      row[columns_[i].quantity] = *value * columns_[i].scale;
    }
    TakeSample(row, cells);
  }

  std::optional<double> Number(const Cell& cell) {
    const auto value = NumberFrom<double>(cell.text);
    if (value && std::isfinite(*value)) return value;
    Complain({line_, cell.column}, fmt::format("expected a number, found '{}'", cell.text));
    return std::nullopt;
  }

  void TakeSample(std::map<std::string, double>& row, const std::vector<Cell>& cells) {
    const auto place_of = [&](const std::string& quantity) {
      const auto it = std::find_if(columns_.begin(), columns_.end(),
                                   [&](const Column& c) { return c.quantity == quantity; });
      return Place{line_, cells[static_cast<std::size_t>(it - columns_.begin())].column};
    };
    TrackSample sample{
        .t_s = row["t"], .X_RD = {{row["x"], row["y"], row["z"]}}, .place = {line_, 1}};
    if (track.samples.empty()) first_t_s_ = sample.t_s;
    sample.t_s -= first_t_s_;
    if (!track.samples.empty() && sample.t_s <= track.samples.back().t_s)
      return Complain(place_of("t"),
                      fmt::format("the times must increase from row to row: {} s comes after {} s",
                                  row["t"], first_t_s_ + track.samples.back().t_s));
    for (const char* axis : {"x", "y", "z"}) {
      if (std::abs(row[axis]) > kMaxTrackCoordinate_m)
        return Complain(
            place_of(axis),
            fmt::format("{}: {} m is beyond {} m", axis, row[axis], kMaxTrackCoordinate_m),
            "does the unit match the header?");
    }
    if (has_quaternion_) {
      const Eigen::Quaterniond q(row["qw"], row["qx"], row["qy"], row["qz"]);
      if (std::abs(q.norm() - 1) > kUnitTolerance)
        return Complain(
            place_of("qw"),
            fmt::format("qw, qx, qy, qz: expected a unit quaternion, found one of length {:.4g}",
                        q.norm()));
      sample.X_RD.q = q.normalized();
    } else {
      sample.X_RD.q = physics::FromRollPitchYaw({row["roll"], row["pitch"], row["yaw"]});
    }
    if (const auto trigger = row.find("trigger"); trigger != row.end()) {
      if (trigger->second < 0 || trigger->second > 1)
        return Complain(
            place_of("trigger"),
            fmt::format("trigger: expected a number from 0 to 1, found {}", trigger->second));
      sample.trigger = trigger->second;
    }
    if (track.samples.size() == kMaxTrackSamples)
      return Complain({line_, 1}, fmt::format("more than {} rows", kMaxTrackSamples));
    track.samples.push_back(sample);
  }

  int line_ = 0;
  bool header_ = false, has_quaternion_ = false;
  std::vector<Column> columns_;  ///< empty until there is a good header
  double first_t_s_ = 0;
};

// The format of aframe-motion-capture-components 0.2.7 (src/components/motion-capture-recorder.js):
// metres, y up, z towards the viewer, Euler angles in degrees applied in the order y, x, z,
// milliseconds. JSON is YAML, so the located YAML reader reads it.

constexpr double kSPerMs = 1e-3;
constexpr int kMaxButtons = 1000;
constexpr std::string_view kButtonEvents[] = {"buttonchanged", "buttondown", "buttonup"};

struct XyzYaml {
  double x = 0, y = 0, z = 0;
};
struct CapturedPose {
  Where where;
  XyzYaml position, rotation;
  Located<double> timestamp;
};

ValueFormat<XyzYaml> XyzFormat(double most) {
  return StructFormat<XyzYaml>("a vector")
      .Required("x", &XyzYaml::x, Number(-most, most), "")
      .Required("y", &XyzYaml::y, Number(-most, most), "")
      .Required("z", &XyzYaml::z, Number(-most, most), "")
      .format();
}

ValueFormat<std::vector<CapturedPose>> PosesFormat() {
  using P = CapturedPose;
  return ListOf(StructFormat<P>("a pose")
                    .Required("position", &P::position, XyzFormat(kMaxTrackCoordinate_m), "")
                    .Required("rotation", &P::rotation, XyzFormat(1e4), "")
                    .Required("timestamp", &P::timestamp, Number(-1e15, 1e15), "")
                    .format(),
                2, kMaxTrackSamples);
}

/// From A-Frame's axes (x right, y up, z back) to ours (x ahead, y left, z up), of the world and of
/// devices alike.
physics::Pose ToOurAxes(const CapturedPose& pose) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const Eigen::Quaterniond q =
      AngleAxisd(pose.rotation.y * physics::kRadPerDeg, Vector3d::UnitY()) *
      AngleAxisd(pose.rotation.x * physics::kRadPerDeg, Vector3d::UnitX()) *
      AngleAxisd(pose.rotation.z * physics::kRadPerDeg, Vector3d::UnitZ());
  return {{-pose.position.z, -pose.position.x, pose.position.y},
          Eigen::Quaterniond(q.w(), -q.z(), -q.x(), q.y())};
}

/// A change of the trigger. Events may have less information; see ReadPresses().
struct Press {
  double t_s = 0;
  double value = 0;
  bool ramp = false;  ///< within `press_s`, since the recording only knows pressed and released
};

const YamlNode* FindAll(const YamlNode& node, std::initializer_list<const char*> keys) {
  const YamlNode* found = &node;
  for (const char* key : keys) {
    if (found) found = found->Find(key);
  }
  return found;
}

class CaptureReader {
 public:
  CaptureReader(const YamlDocument& document, const CapturedDevice& device)
      : document_(document), device_(device), errors_(document) {}

  MotionTrack Read() {
    const YamlNode* device = FindDevice();
    if (!device) return {};
    const YamlNode* written = device->Find("poses");
    if (!written) {
      errors_.Add(device->key_where, fmt::format("'{}' has no 'poses'", device_.name));
      return {};
    }
    std::vector<CapturedPose> poses;
    if (!PosesFormat().Read(*written, errors_, poses)) return {};
    MotionTrack track{.file = document_.sources.front().name,
                      .text = document_.sources.front().text};
    const double begin_ms = poses.front().timestamp.value;
    double before_ms = begin_ms;
    for (const CapturedPose& pose : poses) {
      const double t_s = (pose.timestamp.value - begin_ms) * kSPerMs;
      if (!track.samples.empty() && t_s <= track.samples.back().t_s) {
        errors_.Add(pose.timestamp.where,
                    fmt::format("the timestamps must increase from pose to pose: {} ms comes "
                                "after {} ms",
                                pose.timestamp.value, before_ms));
        return {};
      }
      track.samples.push_back({t_s, ToOurAxes(pose), {}, pose.where.place});
      before_ms = pose.timestamp.value;
    }
    AddTrigger(ReadPresses(*device, begin_ms, track.buttons), track);
    return track;
  }

  grammar::Diagnostics diagnostics() const { return errors_.Sorted(); }

 private:
  const YamlNode* FindDevice() {
    if (document_.root.kind != YamlNode::Kind::kMapping) {
      errors_.Add(document_.root.where, "expected an object with the devices of a recording",
                  "like {\"right\": {\"poses\": [...], \"events\": [...]}}");
      return nullptr;
    }
    if (const YamlNode* device = document_.root.Find(device_.name)) return device;
    std::vector<std::string> names;
    for (const YamlNode& child : document_.root.children) names.push_back(child.key);
    errors_.AddUnknownName(document_.root.where,
                           fmt::format("no device is called '{}'", device_.name), device_.name,
                           names);
    return nullptr;
  }

  /// The button's event; nothing for other events and after an error.
  struct ButtonEvent {
    std::string name;
    int id = 0;
    double at_ms = 0;
    std::optional<double> value;
  };
  std::optional<ButtonEvent> ReadButtonEvent(const YamlNode& event) {
    const YamlNode* name = event.Find("name");
    if (!name || std::ranges::count(kButtonEvents, name->text) == 0) return std::nullopt;
    const YamlNode *id = FindAll(event, {"detail", "id"}), *at = event.Find("timestamp"),
                   *value = FindAll(event, {"detail", "state", "value"});
    if (!id || !at) {
      errors_.Add(event.where,
                  fmt::format("a '{}' needs a '{}'", name->text, id ? "timestamp" : "detail.id"));
      return std::nullopt;
    }
    ButtonEvent read{.name = name->text};
    bool good = Integer<int>(0, kMaxButtons).Read(*id, errors_, read.id);
    good &= Number(-1e15, 1e15).Read(*at, errors_, read.at_ms);
    // Many recordings have lost their values: the value is missing or empty.
    const bool has_value =
        good && read.id == device_.button && value && value->kind == YamlNode::Kind::kScalar;
    if (has_value) good &= Number(0, 1).Read(*value, errors_, read.value.emplace());
    return good ? std::optional(std::move(read)) : std::nullopt;
  }

  /// Changes without a value are skipped if the button's presses and releases are recorded.
  std::vector<Press> ReadPresses(const YamlNode& device, double begin_ms, std::set<int>& buttons) {
    std::vector<Press> presses;
    const YamlNode* events = device.Find("events");
    if (!events) return presses;
    bool analog = false;
    for (const YamlNode& event : events->children) {
      const auto read = ReadButtonEvent(event);
      const bool is_change = read && read->name == "buttonchanged";
      if (!read || (is_change && read->id == device_.button && !read->value)) continue;
      buttons.insert(read->id);
      if (read->id != device_.button) continue;
      const double t_s = (read->at_ms - begin_ms) * kSPerMs;
      if (is_change) {
        if (!analog) presses.clear();
        analog = true;
        presses.push_back({t_s, *read->value, false});
      } else if (!analog) {
        presses.push_back({t_s, read->name == "buttondown" ? 1.0 : 0.0, true});
      }
    }
    std::stable_sort(presses.begin(), presses.end(),
                     [](const Press& a, const Press& b) { return a.t_s < b.t_s; });
    return presses;
  }

  void AddTrigger(const std::vector<Press>& presses, MotionTrack& track) const {
    std::size_t next = 0;
    double before = 0, now = 0;  // the trigger when this press began, and its target
    double begin_s = 0;
    bool ramp = false;
    const auto value_at = [&](double t_s) {
      const double x =
          ramp && device_.press_s > 0 ? std::clamp((t_s - begin_s) / device_.press_s, 0.0, 1.0) : 1;
      return before + x * (now - before);
    };
    for (TrackSample& sample : track.samples) {
      for (; next < presses.size() && presses[next].t_s <= sample.t_s; ++next) {
        before = value_at(presses[next].t_s);
        now = presses[next].value;
        begin_s = presses[next].t_s;
        ramp = presses[next].ramp;
      }
      sample.trigger = value_at(sample.t_s);
    }
  }

  const YamlDocument& document_;
  const CapturedDevice& device_;
  DiagnosticList errors_;
};

}  // namespace

Result<MotionTrack> ReadMotionCsv(const std::string& path) {
  PREHEND_TRY(std::string text, ReadTextFile(path));
  CsvReader reader(path, std::move(text));
  reader.Read();
  if (!reader.diagnostics.empty()) return tl::unexpected(std::move(reader.diagnostics));
  return std::move(reader.track);
}

Result<MotionTrack> ReadMotionCapture(const std::string& path, const CapturedDevice& device) {
  Result<YamlDocument> document = ReadYamlFile(path);
  if (!document) {
    for (grammar::Diagnostic& wrong : document.error()) {
      if (const std::size_t at = wrong.message.find("YAML"); at != std::string::npos)
        wrong.message.replace(at, 4, "JSON");
    }
    return tl::unexpected(std::move(document.error()));
  }
  CaptureReader reader(*document, device);
  MotionTrack track = reader.Read();
  grammar::Diagnostics diagnostics = reader.diagnostics();
  if (!diagnostics.empty()) return tl::unexpected(std::move(diagnostics));
  return track;
}

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// The format of aframe-motion-capture-components 0.2.7 (src/components/motion-capture-recorder.js):
// metres, y up, z towards the viewer, Euler angles in degrees applied in the order y, x, z,
// milliseconds. JSON is YAML, so the located YAML reader reads it. Tested by
// tests/harness/scenario/motion/hand_motion_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/motion/hand_motion.h"

namespace prehend::scenario {
namespace {

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

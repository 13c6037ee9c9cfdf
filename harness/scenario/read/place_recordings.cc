// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/place_recordings_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "harness/scenario/format/scenario_formats.h"
#include "harness/scenario/motion/body_motion.h"
#include "harness/scenario/read/read_parts.h"
#include "harness/scenario/read/read_scenario.h"
#include "physics/person/skeleton.h"

namespace prehend::scenario {
namespace {

using grammar::Diagnostic;

constexpr int kUsualButton = 1;

bool IsCapture(const RecordingYaml& entry) { return entry.recording.value.ends_with(".json"); }

Result<MotionTrack> ReadTrack(const std::string& path, const RecordingYaml& entry) {
  if (!IsCapture(entry)) return ReadMotionCsv(path);
  return ReadMotionCapture(
      path, {entry.device->value, entry.button.value_or(Located<int>{kUsualButton, {}}).value,
             entry.press_s});
}

TrackSample Between(const TrackSample& a, const TrackSample& b, double share) {
  TrackSample sample = a;
  sample.X_RD = {a.X_RD.p_m + share * (b.X_RD.p_m - a.X_RD.p_m),
                 a.X_RD.q.slerp(share, b.X_RD.q).normalized()};
  if (a.trigger && b.trigger) *sample.trigger += share * (*b.trigger - *a.trigger);
  return sample;
}

BodySample Between(const BodySample& a, const BodySample& b, double share) {
  BodySample sample = a;
  sample.posture = physics::Mix(a.posture, b.posture, share);
  for (std::size_t i = 0; i < a.points.size(); ++i)
    sample.points[i] += share * (b.points[i] - a.points[i]);
  return sample;
}

/// Only the samples from from_s to to_s, with times since from_s. Between two samples the motion
/// begins there, too, so that recordings of one take stay together; in a gap with the next sample.
template <class Track>
bool Cut(const RecordingYaml& entry, Track& track, DiagnosticList& errors) {
  auto& samples = track.samples;
  const double last_s = samples.back().t_s;
  const double to_s = entry.to_s ? entry.to_s->value : last_s;
  constexpr double kRounded_s = 0.005;  // as lengths are written
  if (to_s > last_s + kRounded_s) {
    errors.Add(entry.to_s->where,
               fmt::format("to_s: expected at most {:.3f}, the length of the recording, found {}",
                           last_s, to_s),
               "without to_s it is played to its end");
    return false;
  }
  constexpr double kFrame_s = 0.0005;  // frames of 0.0333333 s: 30 of them are 1 s
  const double from_s = entry.from_s.value;
  const auto is_early = [&](const auto& s) { return s.t_s < from_s - kFrame_s; };
  const auto first = std::ranges::find_if_not(samples, is_early);
  const bool is_between = first != samples.begin() && first != samples.end() &&
                          first->t_s > from_s + kFrame_s &&
                          first->t_s - (first - 1)->t_s <= entry.max_gap_s;
  if (is_between) {
    auto& before = *(first - 1);
    before = Between(before, *first, (from_s - before.t_s) / (first->t_s - before.t_s));
    before.t_s = from_s;
  }
  std::erase_if(samples, [&](const auto& s) { return is_early(s) || s.t_s > to_s + kFrame_s; });
  const double first_s = samples.empty() ? 0 : samples.front().t_s;
  for (auto& sample : samples) sample.t_s -= first_s;
  const std::size_t recorded = samples.size() - (is_between ? 1 : 0);
  if (recorded >= 2) return true;
  const Where where = entry.to_s ? entry.to_s->where : entry.from_s.where;
  errors.Add(where,
             fmt::format("between {} and {} s the recording has {} of at least 2 samples", from_s,
                         to_s, recorded),
             fmt::format("the recording lasts {:.3f} s", last_s));
  return false;
}

/// The palm in the world, at every sample.
std::vector<physics::TimedPose> Place(const RecordingYaml& entry, const MotionTrack& track) {
  const physics::Pose X_DH{entry.palm_m, physics::FromRollPitchYaw(entry.palm_rpy_deg)};
  const physics::Pose first = track.samples.front().X_RD * X_DH;
  physics::Pose X_WR{Eigen::Vector3d::Zero(), physics::FromRollPitchYaw({0, 0, entry.yaw_deg})};
  if (entry.start_at_m) X_WR.p_m = *entry.start_at_m - X_WR * first.p_m;
  std::vector<physics::TimedPose> poses;
  for (const TrackSample& sample : track.samples)
    poses.push_back({entry.join_s + sample.t_s, X_WR * sample.X_RD * X_DH, sample.trigger});
  return poses;
}

/// The person in the world, at every frame, with her own bone lengths. Her lowest ankle is as high
/// above the floor as when she stands.
std::vector<physics::TimedPosture> Place(const RecordingYaml& entry, const BodyTrack& track,
                                         const PersonActorYaml& person, double scale) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const BodySample& sample : track.samples)
    lowest =
        std::min({lowest, sample.points[kRightAnklePoint].z(), sample.points[kLeftAnklePoint].z()});
  const double floor_m = entry.start_at_m ? entry.start_at_m->z() : person.at_m.value.z();
  const Eigen::Quaterniond yaw = physics::FromRollPitchYaw({0, 0, entry.yaw_deg});
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  if (entry.start_at_m)
    shift_m = *entry.start_at_m - yaw * (scale * track.samples.front().posture.hips_W_m);
  shift_m.z() = floor_m + physics::AnkleHeight(person.height_m) - scale * lowest;
  std::vector<physics::TimedPosture> postures;
  for (const BodySample& sample : track.samples) {
    physics::Posture posture = sample.posture;
    posture.hips_W_m = yaw * (scale * posture.hips_W_m) + shift_m;
    for (Eigen::Vector3d& way : posture.directions_W) way = yaw * way;
    postures.push_back({entry.join_s + sample.t_s, posture});
  }
  return postures;
}

/// Further warnings would repeat the same.
constexpr std::size_t kMaxOddities = 12;

/// Reports gaps and jumps of hips, hands and feet, in metres.
grammar::Diagnostics CheckBodyTrack(const BodyTrack& track, const RecordingYaml& entry,
                                    double scale) {
  const double frame_s = track.samples[1].t_s - track.samples[0].t_s;
  if (frame_s > entry.max_gap_s) {
    return {grammar::DiagnosticAt(
        track.file, track.text, track.samples[1].place,
        fmt::format("gap: frames are {:.3f} s apart; at most {} s are bridged", frame_s,
                    entry.max_gap_s),
        "raise max_gap_s")};
  }
  const TrackLimits limits{std::numeric_limits<double>::infinity(), entry.max_jump_m};
  grammar::Diagnostics odd;
  for (std::size_t i = 0; i < kWatchedPoints.size(); ++i) {
    MotionTrack point{.file = track.file, .text = track.text};
    for (const BodySample& sample : track.samples)
      point.samples.push_back({sample.t_s, {scale * sample.points[i]}, {}, sample.place});
    for (Diagnostic& found : CheckTrack(point, limits)) {
      if (odd.size() == kMaxOddities) return odd;
      found.message = fmt::format("{}: {}", kWatchedPoints[i], found.message);
      odd.push_back(std::move(found));
    }
  }
  return odd;
}

class RecordingReader {
 public:
  RecordingReader(const std::string& scenario_file,
                  const std::vector<Named<PersonActorYaml>>& persons,
                  const ScenarioLibrary& library, DiagnosticList& errors,
                  grammar::Diagnostics& in_recordings)
      : persons_(persons),
        folder_(std::filesystem::path(scenario_file).parent_path().string()),
        library_(library),
        errors_(errors),
        in_recordings_(in_recordings) {}

  void Fill(const std::string& actor, RecordingYaml& entry) {
    if (entry.recording.value.ends_with(".bvh")) return FillBody(actor, entry);
    if (!CheckKind(entry)) return;
    Result<MotionTrack> track = ReadTrack(PathOf(entry), entry);
    if (!track) return Refuse(entry, std::move(track.error()));
    if (!CheckButton(entry, *track)) return;
    if (!Cut(entry, *track, errors_)) return;
    if (!Accept(entry, CheckTrack(*track, {entry.max_gap_s, entry.max_jump_m}))) return;
    if (!HasRoom(entry, track->samples.size())) return;
    entry.poses = Place(entry, *track);
    for (std::size_t i = 0; i < entry.poses.size(); ++i) {
      if (entry.poses[i].X_WH.p_m.norm() <= kMaxDistance_m) continue;
      return Refuse(
          entry,
          {grammar::DiagnosticAt(
              track->file, track->text, track->samples[i].place,
              fmt::format("the motion is more than {} m from the origin here", kMaxDistance_m),
              "start_at_m shifts the whole motion")});
    }
  }

 private:
  void FillBody(const std::string& actor, RecordingYaml& entry) {
    const auto person = std::find_if(persons_.begin(), persons_.end(),
                                     [&](const auto& p) { return p.name == actor; });
    if (person == persons_.end()) {
      return errors_.Add(entry.recording.where,
                         "recording: a BVH file moves a whole body, not a hand",
                         "give this step to a person; hands follow .csv and .json files");
    }
    Result<BodyTrack> track = ReadBodyTrack(PathOf(entry));
    if (!track) return Refuse(entry, std::move(track.error()));
    if (!Cut(entry, *track, errors_)) return;
    const double scale = entry.scale
                             ? entry.scale->value
                             : physics::LegLength(person->value.height_m) / track->leg_units;
    if (!CheckScale(entry, scale * track->leg_units, person->value)) return;
    if (!Accept(entry, CheckBodyTrack(*track, entry, scale))) return;
    if (!HasRoom(entry, track->samples.size())) return;
    entry.postures = Place(entry, *track, person->value, scale);
    for (std::size_t i = 0; i < entry.postures.size(); ++i) {
      if (entry.postures[i].posture.hips_W_m.norm() <= kMaxDistance_m) continue;
      return Refuse(
          entry,
          {grammar::DiagnosticAt(
              track->file, track->text, track->samples[i].place,
              fmt::format("the hips are more than {} m from the origin here", kMaxDistance_m),
              "give the file's unit with scale: metres per unit")});
    }
  }

  /// Legs a third or three times as long as hers mean that the file has another unit.
  bool CheckScale(const RecordingYaml& entry, double legs_m, const PersonActorYaml& person) {
    constexpr double kMaxRatio = 3;
    const double hers_m = physics::LegLength(person.height_m), ratio = legs_m / hers_m;
    if (ratio < kMaxRatio && ratio > 1 / kMaxRatio) return true;
    errors_.Add(
        entry.scale->where,
        fmt::format("scale: the recorded legs would be {:.3g} m long, hers are {:.3g} m", legs_m,
                    hers_m),
        fmt::format("try {:.3g} metres per unit; without scale the motion is scaled to her legs",
                    entry.scale->value / ratio));
    return false;
  }

  std::string PathOf(const RecordingYaml& entry) const {
    const std::string path = (std::filesystem::path(folder_) / entry.recording.value).string();
    return library_.reads_recording ? library_.reads_recording(path) : path;
  }

  /// Keeps the warnings; false when there are errors.
  bool Accept(const RecordingYaml& entry, grammar::Diagnostics odd) {
    const bool refused =
        std::any_of(odd.begin(), odd.end(), [](const Diagnostic& d) { return !d.is_warning; });
    if (refused)
      Refuse(entry, std::move(odd));
    else
      in_recordings_.insert(in_recordings_.end(), odd.begin(), odd.end());
    return !refused;
  }

  /// The same file may be played several times, up to a limit in all.
  bool HasRoom(const RecordingYaml& entry, std::size_t samples) {
    samples_ += samples;
    if (samples_ <= kMaxTrackSamples) return true;
    errors_.Add(entry.recording.where,
                fmt::format("recording: more than {} samples at this point", kMaxTrackSamples));
    return false;
  }

  /// The devices as a hint, "left or right"; "right" if the file cannot be read.
  std::string NamesOfDevices(const RecordingYaml& entry) const {
    const Result<YamlDocument> file = ReadYamlFile(PathOf(entry));
    if (!file || file->root.children.empty()) return "right";
    std::vector<std::string> names;
    for (const YamlNode& device : file->root.children) names.push_back(device.key);
    return fmt::format("{}", fmt::join(names, " or "));
  }

  /// A button that the step names must be pressed in the recording. If the default button is never
  /// pressed but others are, that is a warning.
  bool CheckButton(const RecordingYaml& entry, const MotionTrack& track) {
    if (!IsCapture(entry) || (!entry.button && track.buttons.empty())) return true;
    const int wanted = entry.button.value_or(Located<int>{kUsualButton, {}}).value;
    if (track.buttons.contains(wanted)) return true;
    const std::string pressed = track.buttons.empty() ? "no button is ever pressed"
                                                      : fmt::format("the pressed buttons are {}",
                                                                    fmt::join(track.buttons, ", "));
    const std::string message =
        fmt::format("button {} of '{}' is never pressed", wanted, entry.device->value);
    if (entry.button) {
      errors_.Add(entry.button->where, "button: " + message, pressed);
      return false;
    }
    Diagnostic odd = grammar::DiagnosticAt(track.file, "", {}, message + ", so the grip stays open",
                                           pressed + "; name the trigger with button: N");
    odd.is_warning = true;
    in_recordings_.push_back(std::move(odd));
    return true;
  }

  bool CheckKind(const RecordingYaml& entry) {
    const bool capture = IsCapture(entry);
    if (capture && !entry.device) {
      errors_.Add(entry.recording.where, "recording: a .json file needs the key 'device'",
                  "add device: " + NamesOfDevices(entry));
      return false;
    }
    if (!capture && entry.device)
      errors_.Add(entry.device->where, "device: a CSV file has only one device");
    if (!capture && entry.button)
      errors_.Add(entry.button->where, "button: a CSV file has a trigger but no buttons");
    return capture || (!entry.device && !entry.button);
  }

  void Refuse(const RecordingYaml& entry, grammar::Diagnostics diagnostics) {
    errors_.Add(entry.recording.where,
                fmt::format("recording: '{}' cannot be used, see below", entry.recording.value));
    in_recordings_.insert(in_recordings_.end(), diagnostics.begin(), diagnostics.end());
  }

  const std::vector<Named<PersonActorYaml>>& persons_;
  std::string folder_;
  std::size_t samples_ = 0;  ///< of all recordings so far
  const ScenarioLibrary& library_;
  DiagnosticList& errors_;
  grammar::Diagnostics& in_recordings_;
};

}  // namespace

void ReadRecordings(const std::string& scenario_file, ScenarioYaml& entry,
                    const ScenarioLibrary& library, DiagnosticList& errors,
                    grammar::Diagnostics& in_recordings) {
  RecordingReader reader(scenario_file, entry.persons, library, errors, in_recordings);
  for (StageYaml& stage : entry.script) {
    for (Named<StepYaml>& step : stage) {
      if (auto* recording = std::get_if<RecordingYaml>(&step.value))
        reader.Fill(step.name, *recording);
    }
  }
}

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/recorded_input_test.cc
#include "harness/recorded_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "harness/build_scene.h"
#include "harness/motion_track.h"

namespace prehend::harness {
namespace {

using grammar::Diagnostic;

bool IsCapture(const RecordingEntry& entry) { return entry.recording.value.ends_with(".json"); }

ReadResult<MotionTrack> ReadTrack(const std::string& path, const RecordingEntry& entry) {
  if (!IsCapture(entry)) return ReadMotionCsv(path);
  return ReadMotionCapture(
      path, {entry.device->value, entry.button.value_or(Located<int>{1, {}}).value, entry.press_s});
}

/// Only the samples from from_s to to_s, with times since from_s.
void Cut(const RecordingEntry& entry, MotionTrack& track, Complaints& complaints) {
  std::vector<TrackSample>& samples = track.samples;
  const double last_s = samples.back().t_s;
  const double to_s = entry.to_s ? entry.to_s->value : last_s;
  std::erase_if(samples,
                [&](const TrackSample& s) { return s.t_s < entry.from_s.value || s.t_s > to_s; });
  for (TrackSample& sample : samples) sample.t_s -= entry.from_s.value;
  if (samples.size() >= 2) return;
  const Where where = entry.to_s ? entry.to_s->where : entry.from_s.where;
  complaints.Add(where,
                 fmt::format("between {} and {} s the recording has {} samples, of at least 2",
                             entry.from_s.value, to_s, samples.size()),
                 fmt::format("it takes {:.3f} s", last_s));
}

/// The palm in the world, at every sample.
std::vector<physics::TimedPose> Place(const RecordingEntry& entry, const MotionTrack& track) {
  const physics::Pose X_DH{entry.palm_m, FromRollPitchYaw(entry.palm_rpy_deg)};
  const physics::Pose first = track.samples.front().X_RD * X_DH;
  physics::Pose X_WR{Eigen::Vector3d::Zero(), FromRollPitchYaw({0, 0, entry.yaw_deg})};
  if (entry.start_at_m) X_WR.p_m = *entry.start_at_m - X_WR * first.p_m;
  std::vector<physics::TimedPose> poses;
  for (const TrackSample& sample : track.samples)
    poses.push_back({entry.join_s + sample.t_s, X_WR * sample.X_RD * X_DH, sample.trigger});
  return poses;
}

class RecordingReader {
 public:
  RecordingReader(const std::string& scenario_file, const ScenarioLibrary& library,
                  Complaints& complaints, grammar::Diagnostics& in_recordings)
      : folder_(std::filesystem::path(scenario_file).parent_path().string()),
        library_(library),
        complaints_(complaints),
        in_recordings_(in_recordings) {}

  void Fill(RecordingEntry& entry) {
    if (!CheckKind(entry)) return;
    const std::string path = (std::filesystem::path(folder_) / entry.recording.value).string();
    if (library_.reads_recording) library_.reads_recording(path);
    ReadResult<MotionTrack> track = ReadTrack(path, entry);
    if (!track.value) return Refuse(entry, std::move(track.diagnostics));
    Cut(entry, *track.value, complaints_);
    if (track.value->samples.size() < 2) return;
    grammar::Diagnostics odd = CheckTrack(*track.value, {entry.most_gap_s, entry.most_jump_m});
    const bool refused =
        std::any_of(odd.begin(), odd.end(), [](const Diagnostic& d) { return !d.is_warning; });
    if (refused) return Refuse(entry, std::move(odd));
    in_recordings_.insert(in_recordings_.end(), odd.begin(), odd.end());
    entry.poses = Place(entry, *track.value);
  }

 private:
  bool CheckKind(const RecordingEntry& entry) {
    const bool capture = IsCapture(entry);
    if (capture && !entry.device) {
      complaints_.Add(entry.recording.where, "recording: this file has several devices: which one?",
                      "add device: right");
      return false;
    }
    if (!capture && entry.device)
      complaints_.Add(entry.device->where, "device: a CSV file has only one");
    if (!capture && entry.button)
      complaints_.Add(entry.button->where, "button: a CSV file has a trigger, no buttons");
    return capture || (!entry.device && !entry.button);
  }

  void Refuse(const RecordingEntry& entry, grammar::Diagnostics diagnostics) {
    complaints_.Add(entry.recording.where, fmt::format("recording: '{}' cannot be used, see below",
                                                       entry.recording.value));
    in_recordings_.insert(in_recordings_.end(), diagnostics.begin(), diagnostics.end());
  }

  std::string folder_;
  const ScenarioLibrary& library_;
  Complaints& complaints_;
  grammar::Diagnostics& in_recordings_;
};

}  // namespace

void ReadRecordings(const std::string& scenario_file, ScenarioEntry& entry,
                    const ScenarioLibrary& library, Complaints& complaints,
                    grammar::Diagnostics& in_recordings) {
  RecordingReader reader(scenario_file, library, complaints, in_recordings);
  for (BeatEntry& beat : entry.script) {
    for (Named<StepEntry>& step : beat) {
      if (auto* recording = std::get_if<RecordingEntry>(&step.value)) reader.Fill(*recording);
    }
  }
}

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episode/episode.h"

#include "harness/episode/episodes/recordings.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment.h"
#include "harness/episode/sense/entity_table.h"
#include "harness/episode/sense/sensing.h"

namespace prehend::episode {
namespace {

bool IsComplete(const physics::RunStatus& status) {
  return status.kind == physics::RunStatus::Kind::kCompleted;
}

}  // namespace

tl::unexpected<grammar::Diagnostics> Episode::Failure(const std::string& message) const {
  return tl::unexpected(grammar::Diagnostics{
      {.file = name_.file, .place = {}, .message = name_.scenario + ": " + message}});
}

grammar::EntityTable Episode::entities() const {
  return recording_ ? recording_->header.entity_table : MakeEntityTable(loaded_.scenario);
}

EpisodeHeader Episode::Header() const {
  if (recording_) return recording_->header;
  const std::string& name = name_.scenario;
  return {.episode = name.substr(name.rfind('/') + 1),
          .grammar = loaded_.scenario.grammar,
          .entity_table = entities()};
}

const RunResult& Episode::Played() {
  if (!played_) played_ = RunScenario(loaded_.scenario, loaded_.program, {.record = true});
  return *played_;
}

Result<SegmentedRecording> Episode::SegmentRecorded() {
  return SegmentRecording(*recording_, loaded_.program, name_.file);
}

Result<RunResult> Episode::Run(bool frames) {
  if (name_.origin == Origin::kRecordedRun)
    return frames ? Replay(*file_, row_, loaded_) : Resegment(*file_, row_, loaded_);
  if (name_.origin == Origin::kScenario)
    return played_ ? *played_ : RunScenario(loaded_.scenario, loaded_.program, {.record = frames});
  Result<SegmentedRecording> segmented = SegmentRecorded();
  if (!segmented) return tl::unexpected(std::move(segmented.error()));
  RunResult run;
  run.status.kind = physics::RunStatus::Kind::kCompleted;
  run.ticks = recording_->end_tick - 1;
  run.is_unfinished = !recording_->says_its_end;
  missing_ = std::move(segmented->missing);
  run.timeline = std::move(segmented->timeline);
  run.drawings = truth::EventDrawings(*loaded_.program);
  run.state_hash = HashOfFrames(*recording_);
  for (std::size_t i = 0; frames && i < recording_->frames.size(); ++i)
    run.recording.push_back(PlaceholderSnapshotAt(recording_->header, recording_->frames[i]));
  return run;
}

Result<grammar::Timeline> Episode::Recorded() {
  if (file_) return file_->TimelineOf(row_);
  if (recording_) return Failure("no events were recorded with it");
  return Played().timeline;
}

Episode::End Episode::EachFrame(const std::function<void(const grammar::Frame&)>& look) {
  if (recording_) {
    for (EpisodeFrame& frame : recording_->frames) look(frame.View());
    return End{recording_->end_tick, ""};
  }
  const scenario::Scenario& scenario = loaded_.scenario;
  Sensing sensing(scenario.scene, scenario.sensing);
  if (played_) {
    for (const physics::Snapshot& snapshot : played_->recording) {
      if (sensing.Due(snapshot.tick)) look(sensing.Sense(snapshot));
    }
    return End{played_->ticks + 1, IsComplete(played_->status) ? "" : StatusText(*played_)};
  }
  if (!file_) {
    ScenarioRun playing(scenario, loaded_.program);
    while (playing.Step()) {
      if (playing.sensed()) look(playing.frame());
    }
    const RunResult run = playing.Finish();
    return End{run.ticks + 1, IsComplete(run.status) ? "" : StatusText(run)};
  }
  EpisodeFrames frames(*file_, row_, LayoutOf(scenario.scene));
  const Result<void> read =
      frames.Play([&](const physics::Snapshot& snapshot) { look(sensing.Sense(snapshot)); },
                  [&](std::int64_t tick) { return sensing.Due(tick); });
  End end{row_.ticks + 1, read ? "" : name_.file + ": " + read.error().front().message};
  if (!read || IsComplete(row_.end)) return end;
  RunResult run;
  run.status = row_.end;
  run.timeline.ticks_per_second = row_.ticks_per_second;
  end.failure = StatusText(run);
  return end;
}

Result<grammar::Tick> Episode::EndTick() {
  if (file_ && !IsComplete(row_.end)) return Failure("the episode did not come to a good end");
  if (recording_) return recording_->end_tick;
  if (file_) return row_.ticks + 1;
  if (!IsComplete(Played().status)) return Failure(StatusText(*played_));
  return played_->ticks + 1;
}

Result<std::vector<physics::Snapshot>> Episode::ReadSnapshots(
    const std::function<bool(std::int64_t)>& wanted) const {
  std::vector<physics::Snapshot> snapshots;
  const Result<void> read =
      EpisodeFrames(*file_, row_, LayoutOf(loaded_.scenario.scene))
          .Play([&](const physics::Snapshot& snapshot) { snapshots.push_back(snapshot); }, wanted);
  if (!read) return tl::unexpected(read.error());
  return snapshots;
}

Result<std::vector<physics::Snapshot>> Episode::Snapshots() {
  return file_ ? ReadSnapshots({}) : Played().recording;
}

Result<grammar::Timeline> Episode::Segment(const std::shared_ptr<const grammar::Program>& program) {
  const Result<grammar::Tick> end = EndTick();
  if (!end) return tl::unexpected(end.error());
  if (recording_) return SegmentFrames(*recording_, program, name_.file);
  const scenario::Scenario& scenario = loaded_.scenario;
  if (played_) return Resegment(scenario, played_->recording, program, *end);
  if (!sensed_) {
    const Sensing sensing(scenario.scene, scenario.sensing);
    auto sensed = ReadSnapshots([&](std::int64_t tick) { return sensing.Due(tick); });
    if (!sensed) return tl::unexpected(std::move(sensed.error()));
    sensed_ = std::move(*sensed);
  }
  return Resegment(scenario, *sensed_, program, *end);
}

}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// See harness/command/recorded_episode.h. Tested by tests/program/episodes_test.cc
#include "harness/command/recorded_episode.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/base/shell_quote.h"
#include "harness/episodes/recordings.h"
#include "harness/episodes/resegment_many.h"
#include "harness/episodes/schema.h"
#include "harness/run/run_text.h"
#include "harness/sense/entity_table.h"
#include "harness/sense/sensing.h"

namespace prehend::harness {

Option EpisodeOption() {
  return {.name = "--episode",
          .help =
              "which one of an episode file that holds several: its number, or its scenario\n"
              "(a name, skill/name or a glob)",
          .placeholder = "WHICH"};
}

tl::expected<RecordedEpisode, ExitCode> OpenRecordedOrComplain(const std::string& typed,
                                                               const ParsedOptions& options,
                                                               const CommandContext& context) {
  const auto selected = episodes::SelectEpisodes({typed}, options.Text("--episode"));
  if (!selected) return tl::unexpected(Complain(context, selected.error()));
  if (selected->size() != 1) {
    const std::string message =
        selected->empty()
            ? fmt::format("--episode: no episode matches '{}'", options.Text("--episode"))
            : fmt::format("{} has {} such episodes; --episode selects one, and '{}' shows all",
                          typed, selected->size(), CommandText({"episodes", typed}));
    return tl::unexpected(Complain(context, ExitCode::kNothing, message));
  }
  auto file = episodes::EpisodeFile::Open(typed);
  if (!file) return tl::unexpected(Complain(context, file.error()));
  const auto row =
      std::ranges::find(file->episodes(), selected->front().id, &episodes::EpisodeRow::id);
  if (row == file->episodes().end())
    return tl::unexpected(Complain(context, ExitCode::kNothing, "the episode is gone"));
  const episodes::EpisodeRow found = *row;
  episodes::EpisodeLoader loader(context.root);
  auto loaded = loader.Load(*file, found, {options.Text("--grammar"), options.All("--set")});
  if (!loaded) return tl::unexpected(Complain(context, loaded.error()));
  return RecordedEpisode{std::move(*file), found, std::move(*loaded)};
}

tl::expected<PlayedRun, ExitCode> PlayOrReplay(const std::string& typed,
                                               const ParsedOptions& options,
                                               const CommandContext& context) {
  if (episodes::IsEpisodeFile(typed)) {
    auto opened = OpenRecordedOrComplain(typed, options, context);
    if (!opened) return tl::unexpected(opened.error());
    Result<RunResult> run = episodes::Replay(opened->file, opened->row, opened->loaded);
    if (!run) return tl::unexpected(Complain(context, run.error()));
    return PlayedRun{std::move(opened->loaded), std::move(*run), opened->row.simulated};
  }
  const auto file = FindScenarioOrComplain(typed, context);
  if (!file) return tl::unexpected(file.error());
  Result<LoadedRun> loaded = LoadRun(RequestOf(options, file->path), context.root);
  if (!loaded) return tl::unexpected(Complain(context, loaded.error()));
  RunResult run = RunScenario(loaded->scenario, loaded->program, {.record = true});
  return PlayedRun{std::move(*loaded), std::move(run)};
}

namespace {

/// The same as a source of frames.
Result<EpisodeSource> SourceOf(RecordedEpisode episode) {
  const auto shared = std::make_shared<const RecordedEpisode>(std::move(episode));
  const Scenario& scenario = shared->loaded.scenario;
  EpisodeSource source{.name = scenario.name,
                       .program = shared->loaded.program,
                       .entity_table = MakeEntityTable(scenario),
                       .play = {}};
  if (!shared->row.simulated) {
    auto recording = episodes::ReadRecording(shared->file, shared->row);
    if (!recording) return tl::unexpected(std::move(recording.error()));
    source.entity_table = recording->header.entity_table;
    source.play = [read = std::move(*recording)](const EpisodeSource::Watcher& watch) {
      for (EpisodeFrame frame : read.frames) watch(frame.View());
      return EpisodeSource::Played{read.end_tick, ""};
    };
    return source;
  }
  source.play = [shared](const EpisodeSource::Watcher& watch) {
    const Scenario& played = shared->loaded.scenario;
    Sensing sensing(played.scene, played.sensing);
    episodes::EpisodeFrames frames(shared->file, shared->row, episodes::LayoutOf(played.scene));
    std::string problem =
        frames.Play([&](const physics::Snapshot& snapshot) { watch(sensing.Sense(snapshot)); },
                    [&](std::int64_t tick) { return sensing.Due(tick); });
    if (!problem.empty()) problem = shared->file.path() + ": " + problem;
    const bool completed = shared->row.end.kind == physics::RunStatus::Kind::kCompleted;
    if (problem.empty() && !completed) {
      RunResult run;
      run.status = shared->row.end;
      run.timeline.ticks_per_second = shared->row.ticks_per_second;
      problem = StatusText(run);
    }
    return EpisodeSource::Played{shared->row.ticks + 1, problem};
  };
  return source;
}

}  // namespace

tl::expected<EpisodeSource, ExitCode> OpenEpisodeOrComplain(const ParsedOptions& options,
                                                            const CommandContext& context) {
  const std::string typed = options.Text("scenario");
  const RunRequest request = RequestOf(options, typed);
  const auto reported = [&](const grammar::Diagnostics& diagnostics) {
    return Complain(context, diagnostics);
  };
  if (episodes::IsEpisodeFile(typed)) {
    auto recorded = OpenRecordedOrComplain(typed, options, context);
    if (!recorded) return tl::unexpected(recorded.error());
    return SourceOf(std::move(*recorded)).map_error(reported);
  }
  if (IsRecording(typed)) {
    return OpenRecording(typed, request.grammar, request.settings, context.root)
        .map_error(reported);
  }
  const auto file = FindScenarioOrComplain(typed, context);
  if (!file) return tl::unexpected(file.error());
  return OpenScenario(file->path, request.grammar, request.settings, context.root)
      .map_error(reported);
}

}  // namespace prehend::harness

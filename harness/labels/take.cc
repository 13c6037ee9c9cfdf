// SPDX-License-Identifier: Apache-2.0
// See harness/labels/take.h. Tested by tests/program/labels_test.cc
#include "harness/labels/take.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "grammar/name_events.h"
#include "harness/base/default_grammar.h"
#include "harness/episodes/recordings.h"
#include "harness/episodes/schema.h"
#include "harness/labels/read_labels.h"
#include "harness/sense/entity_table.h"
#include "harness/sense/episode_stream.h"
#include "harness/sense/sensing.h"

namespace prehend::harness::labels {
namespace {

namespace fs = std::filesystem;

Result<Take> TakeOf(Episode read, const std::string& file) {
  const auto episode = std::make_shared<Episode>(std::move(read));
  const grammar::EntityTable& table = episode->header.entity_table;
  Take take{.entities = {},
            .grammar = episode->header.grammar,
            .ticks_per_second = table.ticks_per_second,
            .end = episode->end_tick,
            .recording = episode,
            .segment = {}};
  take.entities = table.entities;
  take.segment = [episode, file](
                     std::shared_ptr<const grammar::Program> program) -> Result<grammar::Timeline> {
    const grammar::EntityTable& entities = episode->header.entity_table;
    grammar::Monitor monitor(program, entities);
    std::vector<grammar::Event> events;
    for (EpisodeFrame& frame : episode->frames) monitor.Advance(frame.View(), events);
    monitor.Finish(episode->end_tick, events);
    if (!monitor.error().empty())
      return tl::unexpected(grammar::Diagnostics{
          {.file = file,
           .place = {},
           .message = "the grammar cannot segment this recording: " + monitor.error()}});
    return grammar::NameEvents(*program, entities, events);
  };
  return take;
}

Result<Take> OpenLines(const std::string& file) {
  Result<Episode> read = ReadEpisode(file);
  if (!read) return tl::unexpected(std::move(read.error()));
  return TakeOf(std::move(*read), file);
}

Result<Take> OpenEpisode(const TakeName& name, const std::string& root) {
  const auto file = episodes::EpisodeFile::Open(name.file);
  if (!file) return tl::unexpected(file.error());
  const auto failed = [&](std::string why) {
    return tl::unexpected(grammar::Diagnostics{
        {.file = name.file, .place = {}, .message = name.scenario + ": " + std::move(why)}});
  };
  const auto row = std::ranges::find(file->episodes(), name.id, &episodes::EpisodeRow::id);
  if (row == file->episodes().end()) return failed("the episode is gone");
  if (row->end.kind != physics::RunStatus::Kind::kCompleted)
    return failed("the episode did not come to a good end");
  if (!row->simulated) {
    Result<Episode> recording = episodes::ReadRecording(*file, *row);
    if (!recording) return tl::unexpected(std::move(recording.error()));
    recording->header.grammar = row->grammar;
    return TakeOf(std::move(*recording), name.file);
  }
  Result<LoadedRun> loaded = episodes::EpisodeLoader(root).Load(*file, *row);
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  const auto scenario = std::make_shared<const Scenario>(std::move(loaded->scenario));
  const auto frames = std::make_shared<std::vector<physics::Snapshot>>();
  Sensing sensing(scenario->scene, scenario->sensing);
  const std::string problem =
      episodes::EpisodeFrames(*file, *row, episodes::LayoutOf(scenario->scene))
          .Play([&](const physics::Snapshot& snapshot) { frames->push_back(snapshot); },
                [&](std::int64_t tick) { return sensing.Due(tick); });
  if (!problem.empty()) return failed(problem);
  const grammar::Tick end = row->ticks + 1;
  Take take{.entities = {},
            .grammar = scenario->grammar,
            .program = loaded->program,
            .ticks_per_second = scenario->scene.world.rate_hz,
            .end = end,
            .segment = {}};
  take.entities = MakeEntityTable(*scenario).entities;
  take.segment = [=](std::shared_ptr<const grammar::Program> program) -> Result<grammar::Timeline> {
    return Resegment(*scenario, *frames, std::move(program), end);
  };
  return take;
}

/// "" if the file cannot be read, which whoever reads all of it reports.
std::string GrammarNamedBy(const TakeName& name) {
  if (name.id == 0) {
    std::ifstream in(name.file);
    std::string line;
    EpisodeStream stream(name.file);
    if (!std::getline(in, line) || !stream.Take(line).empty() || !stream.has_header()) return "";
    return stream.header().grammar;
  }
  const auto file = episodes::EpisodeFile::Open(name.file);
  if (!file) return "";
  const auto row = std::ranges::find(file->episodes(), name.id, &episodes::EpisodeRow::id);
  if (row == file->episodes().end()) return "";
  return row->simulated ? kDefaultGrammar : row->grammar;
}

/// Where the labels of a take may lie in a folder, without ending.
std::vector<fs::path> StemsOf(const TakeName& take, const fs::path& folder) {
  if (take.id == 0) return {folder / fs::path(take.file).stem()};
  return {folder / take.scenario, folder / fs::path(take.scenario).filename()};
}

}  // namespace

Result<Take> OpenTake(const TakeName& name, const std::string& root) {
  return name.id == 0 ? OpenLines(name.file) : OpenEpisode(name, root);
}

Result<std::vector<TakeName>> TakesOf(const std::vector<std::string>& files,
                                      const std::string& which) {
  std::vector<TakeName> takes;
  for (const std::string& file : files) {
    if (!episodes::IsEpisodeFile(file)) {
      takes.push_back({file, 0, fs::path(file).stem().string()});
      continue;
    }
    auto of_file = episodes::SelectEpisodes({file}, which);
    if (!of_file) return tl::unexpected(std::move(of_file.error()));
    takes.insert(takes.end(), of_file->begin(), of_file->end());
  }
  return takes;
}

Result<std::string> OwnGrammar(const std::vector<TakeName>& takes) {
  std::string grammar;
  const TakeName* named_by = nullptr;
  for (const TakeName& take : takes) {
    const std::string own = GrammarNamedBy(take);
    if (own.empty()) continue;
    if (named_by && own != grammar)
      return tl::unexpected(grammar::Diagnostics{
          {.file = take.scenario,
           .place = {},
           .message = fmt::format("it names the grammar {}, and {} the grammar {}", own,
                                  named_by->scenario, grammar),
           .hint = fmt::format("one of them for all: --grammar {}", own)}});
    grammar = own;
    named_by = &take;
  }
  return grammar.empty() ? kDefaultGrammar : grammar;
}

std::vector<std::string> LabelFilesOf(const std::vector<TakeName>& takes,
                                      const std::vector<std::string>& given, std::string& problem) {
  std::error_code error;
  if (given.size() != 1 || !fs::is_directory(given.front(), error)) {
    if (given.size() != takes.size())
      problem = fmt::format(
          "{} recordings and {} files of labels; wanted one file for each recording, in the same "
          "order, or a folder",
          takes.size(), given.size());
    return given;
  }
  std::vector<std::string> files;
  for (const TakeName& take : takes) {
    std::string found;
    for (const fs::path& stem : StemsOf(take, given.front())) {
      for (const std::string& ending : LabelEndings()) {
        const std::string file = stem.string() + ending;
        if (found.empty() && fs::exists(file, error)) found = file;
      }
    }
    if (found.empty() && problem.empty())
      problem =
          fmt::format("{} has no labels of '{}': no {} with one of the endings {}", given.front(),
                      take.scenario, StemsOf(take, given.front()).back().filename().string(),
                      fmt::join(LabelEndings(), ", "));
    files.push_back(found);
  }
  return files;
}

}  // namespace prehend::harness::labels

// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episode/find_episodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <tuple>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/input_files.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/episode_file.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/episodes/query_events.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {
namespace {

bool IsJsonLines(const std::string& typed) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(typed, error)) return typed.ends_with(".jsonl");
  if (typed.ends_with(".yaml") || typed.ends_with(".yml")) return false;
  std::ifstream file = OpenRegular(typed);
  std::string head(4, '\0');
  file.read(head.data(), 4);
  return head.starts_with('{') || head == "\xEF\xBB\xBF{";
}

/// "" if the recording cannot be read, which whoever reads all of it reports.
std::string GrammarNamedIn(const std::string& recording) {
  std::ifstream in = OpenRegular(recording);
  std::string line;
  EpisodeStream stream(recording);
  const bool is_read = std::getline(in, line) && stream.Take(line).empty() && stream.has_header();
  return is_read ? stream.header().grammar : "";
}

tl::expected<EpisodeName, NotFound> ScenarioNamed(const std::string& typed,
                                                  const std::string& root) {
  const std::vector<ScenarioFile> scenarios = ListScenarios(root);
  auto path = FindScenario(scenarios, typed);
  if (!path) path = FindScenario(ShippedScenarios(root), typed);
  if (path)
    return EpisodeName{.file = *path, .number = {}, .scenario = IdOf(ScenarioAt(scenarios, *path))};
  const std::string hint = HintForScenario(scenarios, typed);
  const char* const lacks =
      hint.starts_with("which one") ? "several skills have a scenario '" : "no scenario '";
  NotFound none{.exit_code = ExitCode::kNothing, .message = lacks + typed + "'"};
  if (!hint.empty()) none.message += "; " + hint;
  none.message += " ('" + CommandText({"list"}) + "' shows all)";
  none.typed = typed;
  none.nearest = NearestScenario(scenarios, typed);
  return tl::unexpected(std::move(none));
}

namespace fs = std::filesystem;

/// Plays a scenario into a file. Returns what went wrong.
grammar::Diagnostics Record(RecordRequest request) {
  PREHEND_TRY(const LoadedRun loaded, LoadRun(request.run, request.root, &request.files));
  RunRecorder recorder(request, loaded);
  PlayScenario(loaded, {}, &recorder);
  if (recorder.problem().empty()) return {};
  return {{.file = request.file, .message = recorder.problem()}};
}

grammar::Diagnostics Import(const ImportRequest& request, std::string& warnings) {
  PREHEND_TRY(Recording recording, ReadRecording(request.source));
  PREHEND_TRY(const auto imported, ImportRecording(request, recording));
  warnings += imported.segmented.missing.warnings;
  if (imported.problem.empty()) return {};
  return {{.file = request.file, .message = imported.problem}};
}

/// The recordings in a folder, or its file of takes; empty if it has neither.
std::vector<std::string> RecordingsIn(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(folder, error)) return {};
  if (const std::string takes = (fs::path(folder) / "takes.yaml").string(); IsTakesFile(takes))
    return {takes};
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".jsonl" || ending == ".episodes") files.push_back(entry.path().string());
  }
  std::ranges::sort(files);
  return files;
}

/// Looks for one thing that was typed after another.
class TakeFinder {
 public:
  TakeFinder(const std::string& which, const std::string& root) : which_(which), root_(root) {}

  std::optional<NotFound> Add(const std::string& typed, const TakeEntry& entry = {}) {
    switch (EpisodeKindOf(typed)) {
      case EpisodeKind::kTakes:
        return AddFile(typed);
      case EpisodeKind::kJsonLines:
        Add({typed,
             {},
             std::filesystem::path(typed).stem().string(),
             Origin::kRecording,
             GrammarNamedIn(typed)},
            entry);
        return std::nullopt;
      case EpisodeKind::kEpisodeFile:
        if (const auto kept = EpisodesOf(typed, which_)) {
          for (const EpisodeName& episode : *kept) Add(episode, entry);
        } else {
          std::ranges::copy(kept.error(), std::back_inserter(unread.diagnostics));
        }
        return std::nullopt;
      case EpisodeKind::kScenario:
        break;
    }
    const std::vector<std::string> in_folder = RecordingsIn(typed);
    for (const std::string& file : in_folder)
      if (auto none = Add(file, entry)) return none;
    if (!in_folder.empty()) return std::nullopt;
    std::error_code error;
    if (!typed.ends_with(".yaml") && !typed.ends_with(".yml") &&
        std::filesystem::is_regular_file(typed, error)) {
      if (auto text = typed.ends_with(".jsonl") ? ReadTextFile(typed) : ""; !text)
        return NotFound{.diagnostics = text.error()};
      return NotFound{.message = fmt::format(
                          "{} is neither a recording nor a scenario; of poses '{}' makes one",
                          typed, CommandText({"import", typed, "-o", "NAME.jsonl"}))};
    }
    PREHEND_TRY(auto scenario, ScenarioNamed(typed, root_));
    Add(std::move(scenario), entry);
    return std::nullopt;
  }

  std::vector<Take> takes;
  NotFound unread;

 private:
  /// Once: globs overlap, and a path may be written in several ways.
  void Add(EpisodeName episode, const TakeEntry& entry) {
    std::error_code error;
    std::string file = fs::weakly_canonical(episode.file, error).string();
    if (error) file = episode.file;
    if (!known_.insert({std::move(file), episode.number, entry.take.labels, entry.take.rows})
             .second)
      return;
    for (const std::string& read : {episode.file, entry.take.labels, entry.take.map})
      RememberInput(read);
    episode.asked = entry.grammar;
    takes.push_back(entry.take);
    takes.back().episode = std::move(episode);
  }

  std::optional<NotFound> AddFile(const std::string& path) {
    const auto entries = ReadTakes(path);
    if (!entries) return NotFound{.diagnostics = entries.error()};
    for (const TakeEntry& entry : *entries) {
      // Nor a folder that has one: two that name each other would never end.
      if (IsTakesFile(entry.recording) ||
          IsTakesFile((fs::path(entry.recording) / "takes.yaml").string()))
        return NotFound{.message = path + ": " + entry.recording +
                                   " is a file of takes itself, or a folder with one"};
      if (auto none = Add(entry.recording, entry)) return none;
    }
    return std::nullopt;
  }

  const std::string& which_;
  const std::string& root_;
  std::set<
      std::tuple<std::string, decltype(EpisodeName::number), std::string, decltype(Take::rows)>>
      known_;
};

}  // namespace

EpisodeKind EpisodeKindOf(const std::string& typed) {
  if (IsTakesFile(typed)) return EpisodeKind::kTakes;
  if (IsEpisodeFile(typed)) return EpisodeKind::kEpisodeFile;
  return IsJsonLines(typed) ? EpisodeKind::kJsonLines : EpisodeKind::kScenario;
}

Result<std::vector<EpisodeName>> EpisodesOf(const std::string& path, const std::string& which) {
  PREHEND_TRY(const auto file, EpisodeFile::Open(path));
  if (file.episodes().empty())
    return tl::unexpected(
        grammar::Diagnostics{{.file = path,
                              .message = "has no episodes",
                              .hint = "its recording ended before the first one began"}});
  std::vector<EpisodeName> names;
  for (const EpisodeRow& row : file.episodes()) {
    if (!IsSelected(row, which)) continue;
    names.push_back({path, row.id, row.scenario,
                     row.simulated ? Origin::kRecordedRun : Origin::kRecording, row.grammar});
  }
  return names;
}

tl::expected<std::vector<Take>, NotFound> FindTakes(std::span<const std::string> typed,
                                                    const std::string& which,
                                                    const std::string& root) {
  const auto is_kept = [](const std::string& one) {
    return EpisodeKindOf(one) != EpisodeKind::kScenario &&
           EpisodeKindOf(one) != EpisodeKind::kJsonLines;
  };
  if (!which.empty() && std::ranges::none_of(typed, is_kept))
    return tl::unexpected(
        NotFound{ExitCode::kBadInput,
                 fmt::format("--episode needs episode files; {} is none", typed.front())});
  TakeFinder finder(which, root);
  for (const std::string& one : typed)
    if (auto none = finder.Add(one)) return tl::unexpected(std::move(*none));
  if (!finder.unread.diagnostics.empty()) return tl::unexpected(std::move(finder.unread));
  if (finder.takes.empty())
    return tl::unexpected(
        NotFound{ExitCode::kNothing, fmt::format("--episode: no episode matches '{}'", which)});
  return std::move(finder.takes);
}

tl::expected<std::vector<EpisodeName>, NotFound> FindEpisodes(std::span<const std::string> typed,
                                                              const std::string& which,
                                                              const std::string& root) {
  PREHEND_TRY(auto takes, FindTakes(typed, which, root));
  return EpisodesOf(takes);
}

tl::expected<EpisodeName, NotFound> FindEpisode(const std::string& typed, const std::string& which,
                                                const std::string& root) {
  PREHEND_TRY(auto found, FindEpisodes({&typed, 1}, which, root));
  if (found.size() == 1) return std::move(found.front());
  return tl::unexpected(
      NotFound{ExitCode::kNothing,
               fmt::format("{} has {} such episodes; --episode selects one, and '{}' shows all",
                           typed, found.size(), CommandText({"episode", "list", typed}))});
}

Result<std::string> WhatIsMissing(const std::vector<std::string>& files) {
  StandingFinder finder;
  std::set<std::string> all(files.begin(), files.end());
  std::error_code error;
  for (const std::string& folder : files)
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
      all.insert(entry.path().string());
  for (const std::string& file : all) {
    if (!IsEpisodeFile(file)) continue;
    const Result<void> looked = Guarded(file, [&] { finder.Add(OpenToRead(file)); });
    if (!looked) return tl::unexpected(looked.error());
  }
  return TextOf(finder.Standings());
}

EpisodeKeeper::EpisodeKeeper(std::string root, std::string today, std::string folder)
    : root_(std::move(root)),
      today_(std::move(today)),
      folder_(folder.empty() ? temporary_.path().string() : std::move(folder)) {}

Result<EpisodeName> EpisodeKeeper::Keep(const EpisodeName& episode, const std::string& grammar) {
  if (episode.number) return episode;
  std::string name = episode.scenario;
  std::ranges::replace(name, '/', '_');
  const std::string source = episode.origin == Origin::kScenario ? episode.scenario : episode.file;
  std::string file = (fs::path(folder_) / (name + ".episodes")).string();
  // Recordings of several folders may have one name.
  for (int i = 2; sources_.contains(file) && sources_[file] != source; ++i)
    file = (fs::path(folder_) / fmt::format("{}_{}.episodes", name, i)).string();
  std::error_code error;
  fs::create_directories(folder_, error);
  fs::remove(file, error);
  sources_[file] = source;
  grammar::Diagnostics problems =
      episode.origin == Origin::kRecording
          ? Import({file, root_, episode.file, grammar, today_, ProgramHash()}, warnings_)
          : Record({file, root_, {.scenario_file = episode.file}, {}, today_, ProgramHash()});
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  PREHEND_TRY(std::vector<EpisodeName> kept, EpisodesOf(file));
  return std::move(kept.front());
}

Result<std::vector<EpisodeName>> EpisodeKeeper::KeepAll(std::vector<EpisodeName> episodes,
                                                        const std::string& grammar) {
  for (EpisodeName& episode : episodes) {
    PREHEND_TRY(episode, Keep(episode, grammar));
  }
  return episodes;
}

std::string EpisodeKeeper::SourceOf(const std::string& file) const {
  const auto source = sources_.find(file);
  return source == sources_.end() ? file : source->second;
}

std::string Lacks(const EpisodeName& episode, Need need) {
  const bool is_recording = episode.origin == Origin::kRecording;
  const std::string& file = episode.file;
  switch (need) {
    case Need::kScenario:
      if (episode.origin == Origin::kScenario) return "";
      return fmt::format("{} {}, so there is no scenario to simulate; '{}' prints its events", file,
                         is_recording ? "is a recording" : "was simulated before",
                         CommandText({"episode", "resegment", file}));
    case Need::kGroundTruth:
      if (!is_recording) return "";
      return episode.scenario +
             " was not simulated, so its physical truth is not known; score it against labels by "
             "people, or its golden: --truth FILE (docs/labels.md)";
    case Need::kRecordedEvents:
      if (episode.number) return "";
      return fmt::format("{} has no events that were recorded with it; '{}' keeps them", file,
                         is_recording ? CommandText({"import", file, "-o", "NAME.episodes"})
                                      : CommandText({"run", file, "--record", "NAME.episodes"}));
    case Need::kEpisodeFile:
      if (episode.number) return "";
      return fmt::format("{} is not kept in an episode file; '{}' makes one", file,
                         is_recording ? CommandText({"import", file, "-o", "NAME.episodes"})
                                      : CommandText({"run", file, "--record", "NAME.episodes"}));
    case Need::kGolden:
      if (!episode.number) return "";
      return is_recording
                 ? fmt::format(
                       "{} has no golden: that of a recording lies beside its JSON Lines; '{}'",
                       file, CommandText({"accept", "NAME.jsonl"}))
                 : fmt::format("{} has no golden: that of its scenario is accepted by name; '{}'",
                               file, CommandText({"accept", episode.scenario}));
  }
  return "";
}

std::string Lack(std::span<const EpisodeName> episodes, Need need) {
  for (const EpisodeName& episode : episodes) {
    if (std::string lack = Lacks(episode, need); !lack.empty()) return lack;
  }
  return "";
}

}  // namespace prehend::episode

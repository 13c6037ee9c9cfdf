// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/load_episode.h"

#include <fmt/format.h>

#include "grammar/contents.h"
#include "harness/episode/episodes/recordings.h"
#include "harness/episode/episodes/write_rows.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment.h"
#include "harness/episode/sense/entity_table.h"
#include "harness/episode/sense/sensing.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {
namespace {

tl::unexpected<grammar::Diagnostics> Failure(const EpisodeFile& file, const EpisodeRow& episode,
                                             const std::string& message) {
  return tl::unexpected(grammar::Diagnostics{
      {.file = file.path(),
       .place = {},
       .message = fmt::format("episode {} ({}): {}", episode.id, episode.scenario, message),
       .source_line = {},
       .hint = {}}});
}

std::uint64_t HashOfText(const std::string& text) {
  std::uint64_t hash = 0;
  for (const char c : text.substr(std::min<std::size_t>(2, text.size()))) {
    const bool is_digit = c >= '0' && c <= '9';
    hash = hash << 4 | static_cast<std::uint64_t>(is_digit ? c - '0' : (c - 'a' + 10) & 15);
  }
  return hash;
}

}  // namespace

Result<Recording> ReadWhole(const EpisodeFile& file, const EpisodeRow& episode) {
  Result<Recording> recording = ReadRecording(file, episode);
  if (!recording) return recording;
  const std::string hash = HashText(HashOfFrames(*recording));
  if (hash == episode.state_hash) return recording;
  return Failure(file, episode,
                 fmt::format("the file is damaged: its frames have the hash {}, recorded was {}",
                             hash, episode.state_hash));
}

void EpisodeLoader::Refresh() {
  if (library_.read_hand && writes_read_ == tasks_.writes()) return;
  library_ = ProjectLibrary(tasks_.root());
  library_.were_played = true;
  std::erase_if(programs_, [](const auto& known) { return known.first.is_own; });
  writes_read_ = tasks_.writes();
}

grammar::CompileResult EpisodeLoader::Compile(bool is_own, const std::string& name_or_path,
                                              const grammar::Overrides& overrides) {
  const GrammarKey key{is_own, name_or_path, overrides};
  if (const auto known = programs_.find(key); known != programs_.end()) return {known->second, {}};
  grammar::CompileResult compiled =
      LoadGrammar(is_own ? tasks_.root() : root_, name_or_path, overrides);
  if (compiled.program) programs_.emplace(key, compiled.program);
  return compiled;
}

Result<LoadedRun> EpisodeLoader::LoadRecording(const EpisodeFile& file, const EpisodeRow& episode,
                                               const TaskFiles& task, const GrammarChoice& choice) {
  Result<EpisodeHeader> header = ReadRecordingHeader(file, episode);
  if (!header) return tl::unexpected(std::move(header.error()));
  Result<grammar::Overrides> overrides = ParameterSettings(choice.settings);
  if (!overrides) return tl::unexpected(std::move(overrides.error()));
  const bool is_own = choice.grammar.empty();
  const std::string asked = tasks_.RequestOf(task).grammar;
  const std::string own = asked.empty() ? header->grammar : asked;
  const std::string name = is_own ? own : choice.grammar;
  grammar::CompileResult compiled = Compile(is_own, name, *overrides);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  LoadedRun loaded{
      .scenario = PlaceholderFor(*header), .program = std::move(compiled.program), .grammar = name};
  loaded.scenario.file = task.run.scenario_file;
  loaded.scenario.grammar = GrammarName(*loaded.program);
  if (!is_own || !choice.settings.empty())
    loaded.warnings = Warnings(*loaded.program, header->entity_table);
  return loaded;
}

Result<LoadedRun> EpisodeLoader::Load(const EpisodeFile& file, const EpisodeRow& episode,
                                      const GrammarChoice& choice) {
  const Result<TaskFiles> task = file.TaskOf(episode);
  if (!task) return tl::unexpected(task.error());
  if (const std::string problem = tasks_.Unpack(*task); !problem.empty())
    return Failure(file, episode, problem);
  Refresh();
  if (!episode.simulated) return LoadRecording(file, episode, *task, choice);
  const auto load_grammar = [&](const std::string& name, const grammar::Overrides& overrides) {
    return Compile(true, name, overrides);
  };
  Result<LoadedRun> loaded =
      LoadRun(tasks_.RequestOf(*task), tasks_.root(), library_, load_grammar);
  if (!loaded) {
    grammar::Diagnostics diagnostics = std::move(loaded.error());
    for (grammar::Diagnostic& diagnostic : diagnostics)
      diagnostic.file = file.path() + ": " + tasks_.Original(diagnostic.file);
    return tl::unexpected(std::move(diagnostics));
  }
  loaded->scenario.file = tasks_.Original(loaded->scenario.file);
  loaded->warnings.clear();  // they were shown when it was recorded
  if (choice.grammar.empty() && choice.settings.empty()) return loaded;

  Result<grammar::Overrides> overrides = ParameterSettings(choice.settings);
  if (!overrides) return tl::unexpected(std::move(overrides.error()));
  const bool is_own = choice.grammar.empty();
  if (!is_own) loaded->grammar = choice.grammar;
  grammar::CompileResult compiled = Compile(is_own, loaded->grammar, *overrides);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  loaded->program = std::move(compiled.program);
  loaded->scenario.grammar = GrammarName(*loaded->program);
  loaded->warnings = Warnings(*loaded->program, MakeEntityTable(loaded->scenario));
  for (grammar::Diagnostic& warning : loaded->warnings)
    warning.file = tasks_.Original(warning.file);
  return loaded;
}

Result<RunResult> Resegment(const EpisodeFile& file, const EpisodeRow& episode,
                            const LoadedRun& loaded) {
  RunResult run;
  run.status = episode.end;
  run.ticks = episode.ticks;
  run.outcome = episode.outcome;
  run.drawings = truth::EventDrawings(*loaded.program);
  Sensing sensing(loaded.scenario.scene, loaded.scenario.sensing);
  EpisodeFrames frames(file, episode, LayoutOf(loaded.scenario.scene));
  Result<void> played;
  const FrameFeed play = [&](const std::function<void(const FrameNews&)>& take) {
    played = frames.Play(
        [&](const physics::Snapshot& snapshot) { take(sensing.SenseChanges(snapshot)); },
        [&](std::int64_t tick) { return sensing.Due(tick); });
    return run.ticks + 1;
  };
  Segmentation segmentation = Segment(loaded.program, MakeEntityTable(loaded.scenario), play);
  if (!played) return tl::unexpected(std::move(played.error()));
  if (!segmentation.problem.empty())
    return Failure(file, episode, "the grammar cannot segment it: " + segmentation.problem);
  run.timeline = std::move(segmentation.timeline);
  run.state_hash = HashOfText(episode.state_hash);
  Result<std::vector<physics::ScriptNote>> notes = file.NotesOf(episode);
  if (!notes) return tl::unexpected(std::move(notes.error()));
  run.notes = std::move(*notes);
  return run;
}

Result<RunResult> Replay(const EpisodeFile& file, const EpisodeRow& episode,
                         const LoadedRun& loaded) {
  Result<RunResult> run = Resegment(file, episode, loaded);
  if (!run) return run;
  physics::StateHash hash;
  EpisodeFrames frames(file, episode, LayoutOf(loaded.scenario.scene));
  const Result<void> played = frames.Play([&](const physics::Snapshot& snapshot) {
    hash.Add(snapshot);
    run->recording.push_back(snapshot);
  });
  if (!played) return tl::unexpected(played.error());
  if (!episode.state_hash.empty() && HashText(hash.value()) != episode.state_hash)
    return Failure(file, episode,
                   fmt::format("the file is damaged: its frames have the state hash {}, recorded "
                               "was {}",
                               HashText(hash.value()), episode.state_hash));
  run->state_hash = hash.value();
  return run;
}

}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// See harness/run/open_episode.h. Tested by tests/program/explain_command_test.cc
#include "harness/run/open_episode.h"

#include <filesystem>
#include <fstream>
#include <utility>

#include "harness/run/load_grammar.h"
#include "harness/run/load_run.h"
#include "harness/run/run_text.h"
#include "harness/sense/entity_table.h"
#include "harness/sense/episode_file.h"

namespace prehend::harness {

bool IsRecording(const std::string& typed) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(typed, error)) return typed.ends_with(".jsonl");
  if (typed.ends_with(".yaml") || typed.ends_with(".yml")) return false;
  std::ifstream file(typed, std::ios::binary);
  return file.get() == '{';
}

Result<EpisodeSource> OpenScenario(const std::string& file, const std::string& grammar,
                                   const std::vector<std::string>& settings,
                                   const std::string& root) {
  Result<LoadedRun> loaded = LoadRun({file, grammar, settings}, root);
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  const Scenario& scenario = loaded->scenario;
  EpisodeSource source{.name = scenario.name,
                       .program = loaded->program,
                       .entity_table = MakeEntityTable(scenario),
                       .play = {}};
  source.play = [run = std::move(*loaded)](const EpisodeSource::Watcher& watch) {
    ScenarioRun playing(run.scenario, run.program);
    while (playing.Step()) {
      if (playing.sensed()) watch(playing.frame());
    }
    const RunResult result = playing.Finish();
    const bool completed = result.status.kind == physics::RunStatus::Kind::kCompleted;
    return EpisodeSource::Played{result.ticks + 1, completed ? "" : StatusText(result)};
  };
  return source;
}

Result<EpisodeSource> OpenRecording(const std::string& file, const std::string& grammar,
                                    const std::vector<std::string>& settings,
                                    const std::string& root) {
  Result<Episode> episode = ReadEpisode(file);
  if (!episode) return tl::unexpected(std::move(episode.error()));
  Result<grammar::Overrides> parameters = ParameterSettings(settings);
  if (!parameters) return tl::unexpected(std::move(parameters.error()));
  const EpisodeHeader& header = episode->header;
  grammar::CompileResult compiled = LoadGrammarOf(header, grammar, root, *parameters);
  if (!compiled.program) return tl::unexpected(std::move(compiled.diagnostics));
  EpisodeSource source{.name = header.episode,
                       .program = std::move(compiled.program),
                       .entity_table = header.entity_table,
                       .play = {}};
  source.play = [recorded = std::move(*episode)](const EpisodeSource::Watcher& watch) {
    for (EpisodeFrame frame : recorded.frames) watch(frame.View());
    return EpisodeSource::Played{recorded.end_tick, ""};
  };
  return source;
}

}  // namespace prehend::harness

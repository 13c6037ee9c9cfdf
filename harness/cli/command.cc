// SPDX-License-Identifier: Apache-2.0
// What commands share. Tested by tests/program/command_line_test.cc
#include "harness/cli/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace prehend::harness {

bool IsGiven(const CLI::App& options, const std::string& name) { return options.count(name) > 0; }

std::string ValueOf(const CLI::App& options, const std::string& name, const std::string& fallback) {
  return IsGiven(options, name) ? options.get_option(name)->results().back() : fallback;
}

std::vector<std::string> ValuesOf(const CLI::App& options, const std::string& name) {
  return options.get_option(name)->results();
}

void DeclareFlag(CLI::App& options, const std::string& name, const std::string& help) {
  options.add_flag(name, help);
}

void DeclareRunOptions(CLI::App& options) {
  options.add_option("--grammar", "another grammar: a name of the library or a .grammar file")
      ->type_name("NAME|FILE")
      ->expected(1);
  options
      .add_option("--set",
                  "change a parameter of the grammar (reach_radius=25cm) or a field of the "
                  "scenario (entities.milk.mass_kg=8)")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

RunRequest RequestOf(const CLI::App& options, const std::string& scenario_file) {
  return {.scenario_file = scenario_file,
          .grammar = ValueOf(options, "--grammar"),
          .settings = ValuesOf(options, "--set")};
}

std::optional<ScenarioFile> FindScenarioOrComplain(const std::string& typed,
                                                   const CommandContext& context) {
  const std::vector<ScenarioFile> scenarios = ListScenarios(context.root);
  const auto path = FindScenario(scenarios, typed);
  if (!path) {
    std::string message = "no scenario '" + typed + "'";
    const std::string hint = HintForScenario(scenarios, typed);
    if (!hint.empty()) message += "; " + hint;
    Complain(context, ExitCode::kNothing, message + " ('prehend list' shows all)");
    return std::nullopt;
  }
  return ScenarioAt(scenarios, *path);
}

OpenedEpisode OpenEpisodeOrComplain(const CLI::App& options, const CommandContext& context) {
  const std::string typed = ValueOf(options, "scenario");
  const RunRequest request = RequestOf(options, typed);
  ReadResult<EpisodeSource> source;
  if (IsRecording(typed)) {
    source = OpenRecording(typed, request.grammar, request.settings, context.root);
  } else {
    const auto file = FindScenarioOrComplain(typed, context);
    if (!file) return {std::nullopt, ExitCode::kNothing};
    source = OpenScenario(file->path, request.grammar, request.settings, context.root);
  }
  if (!source.value) return {std::nullopt, Complain(context, source.diagnostics)};
  return {std::move(source.value), ExitCode::kAgrees};
}

ExitCode Complain(const CommandContext& context, ExitCode code, const std::string& message) {
  context.err << "prehend: " << message << "\n  again: " << context.command_line << "\n";
  return code;
}

ExitCode Complain(const CommandContext& context, const grammar::Diagnostics& diagnostics) {
  constexpr std::size_t kMaxReported = 100;  // nobody reads on
  const std::size_t told = std::min(diagnostics.size(), kMaxReported);
  for (std::size_t i = 0; i < told; ++i) context.err << Format(diagnostics[i]);
  if (told < diagnostics.size()) context.err << "and " << diagnostics.size() - told << " more\n";
  context.err << "  again: " << context.command_line << "\n";
  return ExitCode::kBadInput;
}

}  // namespace prehend::harness

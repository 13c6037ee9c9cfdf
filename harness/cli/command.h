// SPDX-License-Identifier: Apache-2.0
// A command of `prehend`: what it is called, what it accepts, what it does. Each stands in a file
// of its own and is listed in harness/cli/command_line.cc. Results go to `out`, diagnostics to
// `err`. Tested by tests/program/command_line_test.cc
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "harness/base/exit_code.h"
#include "harness/run/find_scenario.h"
#include "harness/run/load_run.h"
#include "harness/run/open_episode.h"

namespace CLI {
class App;
}

namespace prehend::harness {

/// What a command may know of the world around it.
struct CommandContext {
  std::ostream& out;
  std::ostream& err;
  std::string root;          ///< the project's folder
  std::string today;         ///< YYYY-MM-DD
  std::string command_line;  ///< as it could be typed again; ends every failure message
  bool in_ci = false;        ///< nobody is there to accept anything
  bool colored = false;      ///< out may be coloured
  bool progress = false;     ///< err is a terminal
};

struct Command {
  std::string name;
  std::string summary;
  std::string examples;  ///< lines, without indentation
  void (*declare)(CLI::App& options) = nullptr;
  ExitCode (*run)(const CLI::App& options, const CommandContext& context) = nullptr;
};

Command ListCommand();
Command ValidateCommand();
Command RunCommand();
Command CheckCommand();
Command AcceptCommand();
Command ReviewCommand();
Command RenderCommand();
Command NewCommand();
Command ResegmentCommand();
Command SchemaCommand();
Command BenchCommand();
Command ScoreCommand();
Command ExplainCommand();
Command TracksCommand();

// What was typed for an option; `name` is "--json", or "scenario" for a positional.
bool IsGiven(const CLI::App& options, const std::string& name);
std::string ValueOf(const CLI::App& options, const std::string& name,
                    const std::string& fallback = {});
std::vector<std::string> ValuesOf(const CLI::App& options, const std::string& name);

void DeclareFlag(CLI::App& options, const std::string& name, const std::string& help);

/// --grammar and --set, and what was typed for them.
void DeclareRunOptions(CLI::App& options);
RunRequest RequestOf(const CLI::App& options, const std::string& scenario_file);

/// The scenario that was typed, by name or path; otherwise says so, with the nearest name.
std::optional<ScenarioFile> FindScenarioOrComplain(const std::string& typed,
                                                   const CommandContext& context);

/// The episode that was typed for `scenario`, a scenario or a recording, with the run options;
/// otherwise says why not.
struct OpenedEpisode {
  std::optional<EpisodeSource> value;
  ExitCode exit_code = ExitCode::kAgrees;
};
OpenedEpisode OpenEpisodeOrComplain(const CLI::App& options, const CommandContext& context);

/// Prints to `err`, followed by the command line, and returns `code`.
ExitCode Complain(const CommandContext& context, ExitCode code, const std::string& message);
ExitCode Complain(const CommandContext& context, const grammar::Diagnostics& diagnostics);

}  // namespace prehend::harness

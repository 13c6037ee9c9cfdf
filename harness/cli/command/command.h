// SPDX-License-Identifier: Apache-2.0
// A command of `prehend`: its name, what it accepts, what it does. Each stands in a file of its own
// and is listed in harness/cli/cli/command_line.cc. Results go to `out`, diagnostics to `err`. The
// episode that was typed, of any kind. What is wrong is reported here; the exit code is left.
// Tested by tests/program/command_line_test.cc and tests/program/episode_kinds_test.cc
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/exit_code.h"
#include "harness/cli/command/options.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/suite/judge/other_view.h"

namespace prehend::cli {

/// What a command may know about its surroundings.
struct CommandContext {
  std::ostream& out;
  std::ostream& err;
  std::string root;                ///< the project's folder
  std::string today;               ///< YYYY-MM-DD
  std::vector<std::string> words;  ///< what was typed after the program's name
  bool in_ci = false;              ///< there is no person who could accept a golden
  bool colored = false;            ///< `out` may be coloured
  bool progress = false;           ///< `err` is a terminal
};

struct Command {
  std::string name;
  std::string summary;
  std::vector<std::string> examples;  ///< without the program's name
  std::vector<Option> options;
  std::function<ExitCode(const ParsedOptions& options, const CommandContext& context)> run = {};
  std::string note = {};  ///< said at the end of its --help
};

Command ListCommand();
Command PosesCommand();
Command ValidateCommand();
Command RunCommand();
Command CheckCommand();
Command AcceptCommand();
Command ReviewCommand();
Command RenderCommand();
Command NewCommand();
Command ImportCommand();
Command ResegmentCommand();
Command ExportCommand();
Command LabelCommand();
Command SchemaCommand();
Command RenameCommand();
Command BenchCommand();
Command ScoreCommand();
Command ExplainCommand();
Command TracksCommand();
Command DiffCommand();
Command FormatCommand();
Command EpisodesCommand();
Command MergeCommand();
Command VerifyCommand();
Command ReportCommand();
Command QueryCommand();
Command SweepCommand();
Command MarginsCommand();
Command CoverageCommand();
Command FigureCommand();
Command TryCommand();
Command WatchCommand();
Command RecogniserCommand();
Command KnowledgeCommand();
Command AskCommand();

/// The same command, in a process of its own, with the options --time-limit-s (`time_limit_s` where
/// it is not given) and --memory-limit-mb. A run beyond a limit, or one that crashes, ends with
/// exit code 3 and a message.
Command Limited(Command command, double time_limit_s);

/// The same command, which then names what is missing of suites and trials of which its files, the
/// values of this argument, are parts: exit code 3. Not if --episode or --filter selects some.
Command NamingWhatIsMissing(Command command, const std::string& argument);

/// The number of processes that keep this machine busy.
int CoreCount();

/// --grammar and --set.
episode::RunRequest RequestOf(const ParsedOptions& options, const std::string& scenario_file);

/// The scenario that was typed, by name or path; otherwise, after reporting the nearest name, or
/// what an episode of another kind lacks, the exit code.
tl::expected<episode::ScenarioFile, ExitCode> FindScenarioOrComplain(const std::string& typed,
                                                                     const CommandContext& context);

/// Prints "prehend: MESSAGE" to `err`, of a failure also the command that shows it again, and
/// returns `code`.
ExitCode Complain(const CommandContext& context, ExitCode code, const std::string& message);

/// The same of bad input.
ExitCode Refuse(const CommandContext& context, const std::string& message);

ExitCode Complain(const CommandContext& context, const episode::NotFound& none);

/// The same, with the words of the command that should have been typed.
ExitCode ComplainWithCorrection(const CommandContext& context, ExitCode code,
                                const std::string& message,
                                const std::vector<std::string>& corrected);

/// Prints what is wrong with files or with values of options. The command is printed again when
/// there is a file to fix.
ExitCode Complain(const CommandContext& context, const grammar::Diagnostics& diagnostics);

/// Names files of the project that look like scenarios and are not run: a warning, and an error
/// where nobody reads warnings (CI).
ExitCode WarnOfScenariosNotRun(const CommandContext& context);

/// Prints warnings to `err`; nothing when there are none.
void Warn(const CommandContext& context, const grammar::Diagnostics& warnings);

/// All that was typed for an argument, with --episode.
tl::expected<std::vector<episode::Take>, ExitCode> FindTakesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context);

/// The same without what is known beside. What lacks one of `needs` is refused.
tl::expected<std::vector<episode::EpisodeName>, ExitCode> FindEpisodesOrComplain(
    const std::string& argument, const ParsedOptions& options, const CommandContext& context,
    const std::vector<episode::Need>& needs = {});

/// A single one, opened with the grammar and the settings of the command line.
tl::expected<episode::Episode, ExitCode> OpenEpisodeOrComplain(const std::string& typed,
                                                               const ParsedOptions& options,
                                                               const CommandContext& context);

tl::expected<suite::PlayedRun, ExitCode> PlayOrComplain(episode::Episode episode,
                                                        const CommandContext& context);

}  // namespace prehend::cli

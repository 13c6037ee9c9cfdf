// SPDX-License-Identifier: Apache-2.0
// A command of `prehend`: its name, what it accepts, what it does. Large ones stand in a file of
// their own, the others of a noun together; harness/cli/cli/command_line.cc lists all. Results go
// to `out`, diagnostics to `err`. The episode that was typed, of any kind. What is wrong is
// reported here; the exit code is left. Tested by tests/program/command_line_test.cc and
// tests/program/episode_kinds_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/exit_code.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/suite/judge/other_view.h"

namespace prehend::cli {

// What can be typed after a command's name, described as data, and what was typed for it. Knows no
// parser: harness/cli/command/parse_arguments.cc turns the description into one. Tested by
// tests/harness/cli/command/parse_arguments_test.cc

/// Which values an option takes.
struct ValueRule {
  std::string range = {};  ///< for the help: "1 to 256", or ""
  /// What is wrong with a value, or "". It is printed after the option's name.
  std::function<std::string(const std::string& value)> problem = {};
};

/// Numbers from `least` to `most`, both included; whole ones only, or any.
ValueRule IntegersFrom(std::int64_t least, std::int64_t most);
ValueRule NumbersFrom(double least, double most);
/// One of these words; some of them, with commas between them.
ValueRule OneOf(const std::vector<std::string>& words);
ValueRule SomeOf(const std::vector<std::string>& words);

/// One thing that can be typed. A name with dashes is an option, any other name is an argument,
/// which is recognised by its place. An option without placeholder is a flag.
struct Option {
  std::string name;              ///< "--jobs", "scenario"
  std::string help;              ///< one line of `--help`
  std::string placeholder = {};  ///< what stands for the value in the help: "FILE"
  std::string other_name = {};   ///< "-j"
  ValueRule rule = {};
  bool required = false;
  bool repeatable = false;  ///< may be given several times
  bool is_output = false;   ///< names a file that is written
  bool unlisted = false;    ///< the program's help has it, not the command's
  std::string group = {};   ///< heading in the help; "" is the common one
};

/// The same options under a heading of the help.
std::vector<Option> InGroup(const std::string& group, std::vector<Option> options);

/// What is typed without dashes, by its place; an option without a value; one with a value, for
/// which the help has the placeholder.
Option Argument(const std::string& name, const std::string& help, ValueRule rule = {});
Option Flag(const std::string& name, const std::string& help);
Option Value(const std::string& name, const std::string& placeholder, const std::string& help,
             ValueRule rule = {});

/// The same option, which must be given; may be given several times; names a file that is written;
/// is told of in the program's help and not in the command's.
Option Required(Option option);
Option Repeatable(Option option);
Option WritesFile(Option option);
Option Unlisted(Option option);

/// Two lists of options, one after the other.
std::vector<Option> Joined(std::vector<Option> first, std::vector<Option> second);

/// What was typed for the options of one command. Asking for an option that the command does not
/// have is an error of the program: std::out_of_range.
class ParsedOptions {
 public:
  ParsedOptions() = default;
  /// One entry per option of the command, with what was typed for it; of a flag, anything.
  explicit ParsedOptions(std::map<std::string, std::vector<std::string>> values);

  bool Has(const std::string& name) const { return !All(name).empty(); }
  const std::vector<std::string>& All(const std::string& name) const { return values_.at(name); }

  // The value that was typed last, or the fallback. Numbers have passed their option's rule.
  std::string TextOr(const std::string& name, const std::string& fallback) const;
  int IntOr(const std::string& name, int fallback) const;
  std::uint64_t UnsignedOr(const std::string& name, std::uint64_t fallback) const;
  double NumberOr(const std::string& name, double fallback) const;

  /// "" when nothing was typed.
  std::string Text(const std::string& name) const { return TextOr(name, {}); }

 private:
  std::map<std::string, std::vector<std::string>> values_;
};

constexpr int kMaxJobs = 256;
constexpr double kDefaultCollar_ms = 50;
constexpr double kRecogniserLimit_s = 60;

Option ScenarioArgument();
Option EpisodeArgument();       ///< a scenario, an episode file or a recording
Option EpisodesArgument();      ///< any number of them
Option EpisodeFilesArgument();  ///< "files": no others
Option EpisodeOption();         ///< one of an episode file
Option EpisodesOption();        ///< some of episode files
Option GrammarOption();
Option PaceOption();             ///< of a recogniser
Option RecogniserLimitOption();  ///< for an episode
Option SettingsOption();         ///< of a grammar and a scenario
Option ParametersOption();       ///< of a grammar alone
Option OutputOption(const std::string& help, const std::string& placeholder = "FILE",
                    ValueRule rule = {});
Option JobsOption();
Option FilterOption();
/// The program's help tells of both limits and of their defaults.
Option TimeLimitOption(double least_s, double most_s);
Option MemoryLimitOption();
Option JsonOption();

Option MapOption();  ///< what labels mean
/// --truth, --map, --skip-bad-labels, --collar-ms.
std::vector<Option> TruthOptions(const std::string& help, const std::string& placeholder);

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

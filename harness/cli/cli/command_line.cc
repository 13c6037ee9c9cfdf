// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/cli/command_line.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/input_files.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
#include "harness/base/base/visible_stream.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;

/// Why a command is not run at all.
struct Refusal {
  ExitCode exit_code = ExitCode::kBadInput;
  std::string reason;
};

/// Four times what 64 levels of brackets in a grammar were seen to need.
constexpr rlim_t kStack_bytes = 1 << 20;
constexpr const char* kFolders[] = {"scenarios", "golden",   "grammar",
                                    "physics",   "grammars", "hands"};

bool IsBelow(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path real_file = fs::weakly_canonical(fs::absolute(file), error);
  const fs::path real_folder = fs::weakly_canonical(fs::absolute(folder), error);
  return std::ranges::mismatch(real_folder, real_file).in1 == real_folder.end();
}

std::optional<Refusal> RefuseToWrite(const Option& output, const std::string& file,
                                     const std::string& what) {
  std::error_code error;
  return Refusal{ExitCode::kBadInput,
                 fmt::format("{}: {} {} {}; name another file", output.name, ReadableName(file),
                             fs::exists(file, error) ? "is" : "would be", what)};
}

/// The stack must be large enough for what the limits of files allow. Raises the limit of this
/// process if that is permitted.
std::optional<Refusal> RefuseSmallStack() {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= kStack_bytes) return std::nullopt;
  const rlim_t had = limit.rlim_cur;
  limit.rlim_cur = std::min(kStack_bytes, limit.rlim_max);
  if (limit.rlim_cur == kStack_bytes && setrlimit(RLIMIT_STACK, &limit) == 0) return std::nullopt;
  return Refusal{ExitCode::kFailure,
                 fmt::format("found a stack of {} KiB, wanted {} KiB: see ulimit -s", had / 1024,
                             kStack_bytes / 1024)};
}

/// A folder of scenarios, goldens or libraries that cannot be read must not pass for an empty one.
std::optional<Refusal> RefuseUnreadableFolders(const std::string& root) {
  for (const char* const name : kFolders) {
    const fs::path folder = fs::path(root) / name;
    std::error_code error;
    if (!fs::exists(folder, error)) continue;
    fs::recursive_directory_iterator entry(folder, error);
    while (!error && entry != fs::recursive_directory_iterator()) entry.increment(error);
    if (!error) continue;
    return Refusal{CodeOf(error.message()),
                   fmt::format("{} or a folder in it cannot be read: {}",
                               ReadableName(folder.string()), error.message())};
  }
  return std::nullopt;
}

/// All that is named and not written is an input, also before it is read.
void RememberInputs(const Command& command, const ParsedOptions& options) {
  for (const Option& one : command.options) {
    if (one.is_output) continue;
    for (const std::string& file : options.All(one.name)) RememberInput(file);
  }
}

/// What a command writes (Option::is_output) must not replace what it reads, and must not lie among
/// the project's scenarios, goldens and libraries: people write these.
std::optional<Refusal> RefuseOutputsThatAreInputs(const std::string& root, const Command& command,
                                                  const ParsedOptions& options) {
  for (const Option& output : command.options) {
    if (!output.is_output) continue;
    for (const std::string& file : options.All(output.name)) {
      if (file == "-") continue;
      std::error_code error;
      const bool is_for_episodes =
          output.name == "--record" || command.name == "import" || command.name == "episode merge";
      if (!is_for_episodes && fs::is_regular_file(file, error) &&
          episode::EpisodeKindOf(file) == episode::EpisodeKind::kEpisodeFile)
        return RefuseToWrite(output, file, "a file of episodes");
      if (IsBelow(file, fs::path(root) / kProjectFile))
        return RefuseToWrite(output, file, "what makes a folder a project");
      for (const char* const folder : kFolders) {
        if (IsBelow(file, fs::path(root) / folder))
          return RefuseToWrite(output, file, fmt::format("a file of the project's {}/", folder));
      }
      for (const Option& one : command.options) {
        for (const std::string& other : options.All(one.name)) {
          if (!one.is_output && fs::equivalent(file, other, error))
            return RefuseToWrite(output, file, "what is read");
          const auto is = [&](const fs::path& path) {
            return fs::weakly_canonical(file, error) == fs::weakly_canonical(path, error);
          };
          if (one.is_output && one.name != output.name &&
              (is(other) || is(fs::path(other) / "index.html")))
            return RefuseToWrite(output, file, "what " + one.name + " writes");
        }
      }
    }
  }
  return std::nullopt;
}

bool IsSet(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value && std::string_view(value) != "0" && std::string_view(value) != "false";
}

std::string Today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

ExitCode Report(const UsageError& error) {
  std::cerr << "prehend: " << error.message << "\n";
  if (!error.corrected.empty()) std::cerr << "  again: " << CommandText(error.corrected) << "\n";
  std::cerr << "  see: " << ProgramName() << " " << error.command
            << (error.command.empty() ? "" : " ") << "--help\n";
  return ExitCode::kBadInput;
}

ExitCode Print(const InfoText& info) {
  (info.asked_for ? std::cout : std::cerr) << info.text;
  return info.asked_for ? ExitCode::kAgrees : ExitCode::kBadInput;
}

ExitCode Run(const ChosenCommand& chosen, const std::vector<std::string>& words) {
  CommandContext context{
      .out = std::cout, .err = std::cerr, .root = {}, .today = Today(), .words = words};
  context.in_ci = IsSet("CI");
  const char* const terminal = std::getenv("TERM");
  const bool obeys = !terminal || std::string_view(terminal) != "dumb";
  context.colored = obeys && isatty(STDOUT_FILENO) && !IsSet("NO_COLOR");
  context.progress = obeys && isatty(STDERR_FILENO);
  const auto root = FindProjectRoot();
  if (!root) {
    const char* const home = std::getenv("PREHEND_HOME");
    return Refuse(context, home && *home
                               ? "PREHEND_HOME is " + ShellQuoted(ReadableName(home)) +
                                     ", which has neither prehend.yaml nor grammar/library"
                               : std::string("the project's folder was not found (it has "
                                             "prehend.yaml or grammar/library); go there or set "
                                             "PREHEND_HOME"));
  }
  if (ReadableName(*root) != *root)
    return Refuse(context, "the name of the project's folder, " + ReadableName(*root) +
                               ", holds what is no printable text; rename it");
  context.root = *root;
  RememberInputs(*chosen.command, chosen.options);
  for (const auto& refusal : {RefuseSmallStack(), RefuseUnreadableFolders(*root),
                              RefuseOutputsThatAreInputs(*root, *chosen.command, chosen.options)}) {
    if (refusal) return Complain(context, refusal->exit_code, refusal->reason);
  }
  return chosen.command->run(chosen.options, context);
}

/// Words reach goldens, reports and messages, which hold text only. Returns why one is no text, or
/// "".
std::string WhyNotText(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].empty()) continue;
    const grammar::Diagnostics found = CheckText("", words[i]);
    if (!found.empty())
      return fmt::format("argument {} ('{}') is no text: {}", i + 1, ReadableText(words[i]),
                         found.front().message);
  }
  return "";
}

constexpr const char* kFooter =
    R"(Options:
  -h,--help             Print this, or of a command what it does and takes; --version: the version
  --json                Where a command prints results: print JSON instead of text
  --time-limit-s S      Seconds that most commands may take; 0: no limit; default: 600, of many
                        episodes 3600, sweeps 86400, a scenario in 'check' 120, 'episode ask' 10,
                        with --trials or --on-save none
  --memory-limit-mb MB  Memory that it may take; 0: no limit; default: 4000, in 'check' 1000

Exit codes: 0 agrees, 1 differs, 2 bad input or usage, 3 failure, 4 nothing found, 5 goldens wait.
The project is $PREHEND_HOME, or the nearest folder with a prehend.yaml, or the program's checkout.)";

}  // namespace

ExitCode RunCommandLine(int argc, const char* const* argv, const char* commit) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  const VisibleBuffer out(std::cout), err(std::cerr, kMostLine_bytes);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error that says so
  try {
    if (const std::string why = WhyNotText(words); !why.empty()) {
      std::cerr << "prehend: " << why << "\n";
      return ExitCode::kBadInput;
    }
    const std::vector<Command> commands = AllCommands();
    const ParsedArguments parsed = ParseArguments(
        DescribeProgram(std::string("prehend " PREHEND_VERSION) + commit), commands, words);
    if (const auto* error = std::get_if<UsageError>(&parsed)) return Report(*error);
    const auto* const info = std::get_if<InfoText>(&parsed);
    const ExitCode code = info ? Print(*info) : Run(std::get<ChosenCommand>(parsed), words);
    std::cout.flush();
    if (code == ExitCode::kFailure) RemoveLeftFolders();
    if (std::cout) return code;
    std::cerr << "prehend: the output could not be written\n";
  } catch (const std::exception& problem) {
    std::cerr << "prehend: internal error: " << problem.what()
              << "\n  again: " << CommandText(words) << "\n";
  }
  return ExitCode::kFailure;
}

std::vector<Command> AllCommands() {
  // Ten times what the longest scenario takes on a slow machine; there may be many episodes.
  // Grammars are tried with hundreds of settings on them.
  constexpr double kOne_s = 600, kMany_s = 3600, kSettings_s = 86'400;
  return {NewCommand(),
          Limited(ValidateCommand(), kOne_s),
          NamingWhatIsMissing(CheckCommand(), "names"),
          Limited(ReviewCommand(), kOne_s),
          Limited(AcceptCommand(), kMany_s),
          Limited(ListCommand(), kOne_s),
          Limited(RunCommand(), kOne_s),
          Limited(ExplainCommand(), kOne_s),
          Limited(RenderCommand(), kOne_s),
          Limited(FigureCommand(), kMany_s),
          Limited(NamingWhatIsMissing(ReportCommand(), "EPISODES"), kMany_s),
          Limited(ImportCommand(), kMany_s),
          Limited(NamingWhatIsMissing(ScoreCommand(), "names"), kMany_s),
          Limited(EpisodesCommand(), kMany_s),
          Limited(NamingWhatIsMissing(QueryCommand(), "EPISODES"), kMany_s),
          Limited(ResegmentCommand(), kMany_s),
          Limited(ExportCommand(), kMany_s),
          Limited(LabelCommand(), kMany_s),
          Limited(MergeCommand(), kSettings_s),
          Limited(VerifyCommand(), kMany_s),
          Limited(KnowledgeCommand(), kMany_s),
          AskCommand(),
          Limited(TryCommand(), kOne_s),
          Limited(SweepCommand(), kSettings_s),
          Limited(MarginsCommand(), kSettings_s),
          Limited(CoverageCommand(), kMany_s),
          Limited(TracksCommand(), kOne_s),
          DiffCommand(),
          FormatCommand(),
          WatchCommand(),
          Limited(RecogniserCommand(), kOne_s),
          BenchCommand(),
          Limited(PosesCommand(), kOne_s),
          SchemaCommand(),
          RenameCommand()};
}

ProgramDescription DescribeProgram(const std::string& version) {
  return {
      .version = version,
      .summary = "Simulate manipulation, segment it with activity grammars, test both.",
      .footer = kFooter,
      .groups = {{"Write scenarios", {"new", "validate"}},
                 {"Test", {"check", "review", "accept", "list"}},
                 {"Look at an episode", {"run", "explain", "render", "figure", "report"}},
                 {"Use data of your own", {"import", "score"}}},
      .nouns = {{"episode", "Recorded episodes"},
                {"grammar", "Rules"},
                {"scenario", "What scenarios are made of"}},
      .old_commands = {{"episodes", "episode list"},
                       {"query", "episode query"},
                       {"resegment", "episode resegment"},
                       {"replay", "episode verify"},
                       {"knowledge", "episode knowledge"},
                       {"ask", "episode ask"},
                       {"try", "grammar try"},
                       {"sweep", "grammar sweep"},
                       {"margins", "grammar margins"},
                       {"tracks", "grammar tracks"},
                       {"watch", "grammar watch"},
                       {"bench", "grammar bench"},
                       {"poses", "scenario poses"},
                       {"schema", "scenario schema"}},
      .old_options = {{"validate --watch", "--on-save"},
                      {"check --time-limit", "--time-limit-s"},
                      {"new --verb", "--like"},
                      {"render --only", "--hand"},
                      {"render --theme", "--look"},
                      {"render --transparent", "--look=transparent"},
                      {"render --regions", "--look=regions"},
                      {"figure --only", "--hand"},
                      {"figure --theme", "--look"},
                      {"figure --transparent", "--look=transparent"},
                      {"figure --regions", "--look=regions"},
                      {"score --events", "--event"},
                      {"score --differences", "--verbose"},
                      {"score --online", "--pace=online"},
                      {"score --real-time", "--pace=real_time"},
                      {"episode resegment --compare", "--against"},
                      {"episode resegment --labels", "--output"},
                      {"episode resegment --events", "--event"},
                      {"episode label --write", "--output"},
                      {"episode query --class", "--role"},
                      {"episode query --at-least-s", "--lasts-s"},
                      {"episode query --at-most-s", "--lasts-s=.."},
                      {"episode query --scenario", "--episode"},
                      {"episode query --from-s", "--from"},
                      {"episode query --until-s", "--to"},
                      {"episode knowledge --to", "--also"},
                      {"episode ask --seconds", "--time-limit-s"},
                      {"grammar margins --only", "--over"},
                      {"grammar sweep --picture", "--output"},
                      {"grammar recogniser --online", "--pace=online"},
                      {"scenario schema --import-map", "import-map"}},
  };
}

}  // namespace prehend::cli

// SPDX-License-Identifier: Apache-2.0
// See harness/cli/command_line.h. Tested by tests/program/command_line_test.cc
#include "harness/cli/command_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>

#include "harness/base/project_paths.h"
#include "harness/base/shell_quote.h"
#include "harness/base/text_file.h"
#include "harness/command/parse_arguments.h"
#include "harness/command/preconditions.h"

namespace prehend::harness {
namespace {

std::vector<Command> Commands() {
  // Ten times what the longest scenario takes on a slow machine; there may be many episodes.
  // Grammars are tried with hundreds of settings on them.
  constexpr double kOne_s = 600, kMany_s = 3600, kSettings_s = 86'400;
  return {Limited(ListCommand(), kOne_s),
          Limited(ValidateCommand(), kOne_s),
          Limited(RunCommand(), kOne_s),
          CheckCommand(),
          Limited(AcceptCommand(), kMany_s),
          Limited(ReviewCommand(), kOne_s),
          Limited(RenderCommand(), kOne_s),
          Limited(PosesCommand(), kOne_s),
          NewCommand(),
          SchemaCommand(),
          BenchCommand(),
          Limited(ImportCommand(), kOne_s),
          Limited(ResegmentCommand(), kMany_s),
          Limited(QueryCommand(), kMany_s),
          Limited(ScoreCommand(), kMany_s),
          Limited(ExplainCommand(), kOne_s),
          Limited(TracksCommand(), kOne_s),
          Limited(EpisodesCommand(), kMany_s),
          Limited(MigrateCommand(), kMany_s),
          Limited(ReplayCommand(), kMany_s),
          Limited(ReportCommand(), kMany_s),
          Limited(SweepCommand(), kSettings_s),
          Limited(MarginsCommand(), kSettings_s),
          Limited(FigureCommand(), kMany_s),
          Limited(KnowledgeCommand(), kMany_s),
          AskCommand(),
          WatchCommand(),
          Limited(TryCommand(), kOne_s)};
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

ProgramDescription Description() {
  return {
      .version = "prehend " PREHEND_VERSION,
      .summary =
          "Simulate manipulation, segment it with activity grammars, compare it with goldens.",
      .footer =
          "Exit codes: 0 agrees, 1 differs, 2 bad input or usage, 3 simulation or internal "
          "failure,\n"
          "4 nothing was selected or found, 5 goldens wait for acceptance.\n"
          "The project is the folder that PREHEND_HOME names; otherwise the nearest folder, the "
          "working\none or above, with a prehend.yaml; otherwise the checkout of the program."};
}

ExitCode Report(const UsageError& error) {
  std::cerr << "prehend: " << error.message << "\n";
  if (!error.corrected.empty()) std::cerr << "  again: " << CommandText(error.corrected) << "\n";
  std::vector<std::string> help = {"--help"};
  if (!error.command.empty()) help.insert(help.begin(), error.command);
  std::cerr << "  see: " << CommandText(help) << "\n";
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
  context.colored = isatty(STDOUT_FILENO) && !IsSet("NO_COLOR");
  context.progress = isatty(STDERR_FILENO);
  const auto root = FindProjectRoot();
  if (!root) {
    const char* const home = std::getenv("PREHEND_HOME");
    return Complain(context, ExitCode::kBadInput,
                    home && *home ? "PREHEND_HOME is " + ShellQuoted(ReadableName(home)) +
                                        ", which has neither prehend.yaml nor grammar/library"
                                  : std::string("the project's folder was not found (it has "
                                                "prehend.yaml or grammar/library); go there or set "
                                                "PREHEND_HOME"));
  }
  if (ReadableName(*root) != *root)
    return Complain(context, ExitCode::kBadInput,
                    "the name of the project's folder, " + ReadableName(*root) +
                        ", holds what is no printable text; rename it");
  context.root = *root;
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

}  // namespace

ExitCode RunCommandLine(int argc, const char* const* argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  try {
    if (const std::string why = WhyNotText(words); !why.empty()) {
      std::cerr << "prehend: " << why << "\n";
      return ExitCode::kBadInput;
    }
    const std::vector<Command> commands = Commands();
    const ParsedArguments parsed = ParseArguments(Description(), commands, words);
    if (const auto* error = std::get_if<UsageError>(&parsed)) return Report(*error);
    const auto* const info = std::get_if<InfoText>(&parsed);
    const ExitCode code = info ? Print(*info) : Run(std::get<ChosenCommand>(parsed), words);
    std::cout.flush();
    if (std::cout) return code;
    std::cerr << "prehend: the output could not be written\n";
  } catch (const std::exception& problem) {
    std::cerr << "prehend: internal error: " << problem.what()
              << "\n  again: " << CommandText(words) << "\n";
  }
  return ExitCode::kFailure;
}

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// See harness/cli/cli/command_line.h. Tested by tests/program/command_line_test.cc
#include "harness/cli/cli/command_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>

#include "harness/base/base/project_paths.h"
#include "harness/base/base/shell_quote.h"
#include "harness/base/base/text_file.h"
#include "harness/cli/cli/command_tree.h"
#include "harness/cli/command/preconditions.h"

namespace prehend::cli {
namespace {

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

ExitCode RunCommandLine(int argc, const char* const* argv, const char* commit) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
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
    if (std::cout) return code;
    std::cerr << "prehend: the output could not be written\n";
  } catch (const std::exception& problem) {
    std::cerr << "prehend: internal error: " << problem.what()
              << "\n  again: " << CommandText(words) << "\n";
  }
  return ExitCode::kFailure;
}

}  // namespace prehend::cli

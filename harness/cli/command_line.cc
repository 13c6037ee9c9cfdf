// SPDX-License-Identifier: Apache-2.0
// See harness/cli/command_line.h. Tested by tests/program/command_line_test.cc
#include "harness/cli/command_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>
#include <regex>

#include "harness/base/project_paths.h"
#include "harness/base/shell_quote.h"
#include "harness/cli/command.h"

namespace prehend::harness {
namespace {

std::vector<Command> Commands() {
  return {ListCommand(),      ValidateCommand(), RunCommand(),     CheckCommand(),  AcceptCommand(),
          ReviewCommand(),    RenderCommand(),   NewCommand(),     SchemaCommand(), BenchCommand(),
          ResegmentCommand(), ScoreCommand(),    ExplainCommand(), TracksCommand()};
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

std::string CommandLineText(int argc, const char* const* argv) {
  std::string text = "prehend";
  for (int i = 1; i < argc; ++i) text += " " + ShellQuoted(argv[i]);
  return text;
}

std::string Suggestion(const std::string& typed, const std::vector<std::string>& known) {
  const std::string near = grammar::NearestName(typed, known);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
}

ExitCode UsageError(const std::string& message, const std::string& command) {
  std::cerr << fmt::format("prehend: {}\n  see: prehend {}--help\n", message,
                           command.empty() ? "" : command + " ");
  return ExitCode::kBadInput;
}

std::vector<std::string> LongOptions(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

void Declare(CLI::App& app, const std::vector<Command>& commands) {
  app.description(
      "Simulated manipulation, segmented by activity grammars, compared with goldens, pictured.");
  app.footer(
      "Exit codes: 0 agrees, 1 differs, 2 bad input or usage, 3 simulation or internal failure,\n"
      "4 nothing selected or found, 5 goldens wait for acceptance.\n"
      "PREHEND_HOME names the project's folder; otherwise it is the one above the program, or the "
      "working folder.");
  app.set_version_flag("--version", "prehend " PREHEND_VERSION, "Print the version and exit");
  app.allow_extras();
  for (const Command& command : commands) {
    CLI::App* options = app.add_subcommand(command.name, command.summary);
    std::string footer = "Examples:";
    for (std::size_t begin = 0; begin < command.examples.size();) {
      const std::size_t end = std::min(command.examples.find('\n', begin), command.examples.size());
      footer += "\n  " + command.examples.substr(begin, end - begin);
      begin = end + 1;
    }
    options->footer(footer);
    options->allow_extras();
    command.declare(*options);
  }
}

/// What nobody declared, as a suggestion.
ExitCode ComplainAboutExtra(const CLI::App& app, const std::string& extra,
                            const std::string& command) {
  if (!extra.starts_with('-'))
    return UsageError(fmt::format("unexpected argument '{}'", extra), command);
  const std::string name = extra.substr(0, extra.find('='));
  return UsageError(fmt::format("unknown option '{}'{}", name, Suggestion(name, LongOptions(app))),
                    command);
}

/// The first option, or name, that was given as an empty word; "" when none was.
std::string GivenAsNothing(const CLI::App& options) {
  for (const CLI::Option* option : options.get_options()) {
    for (const std::string& value : option->results()) {
      if (value.empty()) return option->get_name();
    }
  }
  return "";
}

/// "not in range 0.100000 to 5.000000" without the zeros.
std::string WithShortNumbers(const std::string& message) {
  static const std::regex zeros("(\\d\\.\\d*?[1-9])0+\\b|(\\d)\\.0+\\b");
  return std::regex_replace(message, zeros, "$1$2");
}

ExitCode Dispatch(const CLI::App& app, const std::vector<Command>& commands,
                  const std::string& command_line) {
  const auto chosen = app.get_subcommands();
  const std::vector<std::string> extras = app.remaining(/*recurse=*/true);
  if (chosen.empty()) {
    if (extras.empty()) return std::cerr << app.help(), ExitCode::kBadInput;
    if (extras.front().starts_with('-')) return ComplainAboutExtra(app, extras.front(), "");
    std::vector<std::string> names;
    for (const Command& command : commands) names.push_back(command.name);
    return UsageError(
        fmt::format("unknown command '{}'{}", extras.front(), Suggestion(extras.front(), names)),
        "");
  }
  const CLI::App& options = *chosen.front();
  if (!extras.empty()) return ComplainAboutExtra(options, extras.front(), options.get_name());

  CommandContext context{.out = std::cout,
                         .err = std::cerr,
                         .root = {},
                         .today = Today(),
                         .command_line = command_line};
  context.in_ci = IsSet("CI");
  context.colored = isatty(STDOUT_FILENO) && !IsSet("NO_COLOR");
  context.progress = isatty(STDERR_FILENO);
  const std::string nothing = GivenAsNothing(options);
  if (!nothing.empty())
    return UsageError(nothing + ": an empty word is given for it", options.get_name());
  const auto root = FindProjectRoot();
  if (!root) {
    const char* const home = std::getenv("PREHEND_HOME");
    return Complain(
        context, ExitCode::kBadInput,
        home && *home
            ? "PREHEND_HOME is " + ShellQuoted(home) + ", which has no grammar/library"
            : std::string(
                  "the project's folder was not found (it has grammar/library); go there or "
                  "set PREHEND_HOME"));
  }
  context.root = *root;
  for (const Command& command : commands) {
    if (command.name == options.get_name()) return command.run(options, context);
  }
  return UsageError("unknown command", "");
}

}  // namespace

ExitCode RunCommandLine(int argc, const char* const* argv) {
  const std::vector<Command> commands = Commands();
  const std::string command_line = CommandLineText(argc, argv);
  CLI::App app("", "prehend");
  try {
    Declare(app, commands);
    app.parse(argc, argv);
    const ExitCode code = Dispatch(app, commands, command_line);
    std::cout.flush();
    if (!std::cout)
      return std::cerr << "prehend: the output could not be written\n", ExitCode::kFailure;
    return code;
  } catch (const CLI::Success& help) {
    app.exit(help, std::cout, std::cerr);
    return ExitCode::kAgrees;
  } catch (const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    return UsageError(WithShortNumbers(error.what()),
                      chosen.empty() ? "" : chosen.front()->get_name());
  } catch (const std::exception& problem) {
    std::cerr << "prehend: internal error: " << problem.what() << "\n  again: " << command_line
              << "\n";
    return ExitCode::kFailure;
  }
}

}  // namespace prehend::harness

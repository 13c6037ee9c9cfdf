// SPDX-License-Identifier: Apache-2.0
// See harness/command/parse_arguments.h. CLI11 splits the words and prints the help; what is wrong
// with them is worded here. Tested by tests/harness/command/parse_arguments_test.cc
#include "harness/command/parse_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/base/shell_quote.h"

namespace prehend::harness {
namespace {

bool IsArgument(const Option& option) { return !option.name.starts_with('-'); }
bool IsFlag(const Option& option) { return !IsArgument(option) && option.placeholder.empty(); }

void Declare(const Option& option, CLI::App& app) {
  const std::string names =
      option.other_name.empty() ? option.name : option.name + "," + option.other_name;
  const std::string help =
      option.rule.range.empty() ? option.help : option.help + " (" + option.rule.range + ")";
  CLI::Option* declared = nullptr;
  if (IsFlag(option)) {
    declared = app.add_flag(names, help);
  } else {
    declared = app.add_option(names, help)->type_name(option.placeholder);
    declared->expected(IsArgument(option) && option.repeatable ? -1 : 1);
    declared->required(option.required);
  }
  // An option that is given twice is an error of ours, with a text of ours.
  if (!IsArgument(option) || option.repeatable)
    declared->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  if (!option.group.empty()) declared->group(option.group);
}

void Declare(const Command& command, CLI::App& app) {
  CLI::App* declared = app.add_subcommand(command.name, command.summary);
  std::string footer = "Examples:";
  for (const std::string& example : command.examples)
    footer += "\n  " + ProgramName() + " " + example;
  if (!command.note.empty()) footer += "\n\n" + command.note;
  declared->footer(footer);
  declared->allow_extras();
  for (const Option& option : command.options) Declare(option, *declared);
}

/// The words with the first `wrong` replaced; also in "wrong=value".
std::vector<std::string> Corrected(std::vector<std::string> words, const std::string& wrong,
                                   const std::string& right) {
  const auto found = std::ranges::find_if(words, [&](const std::string& word) {
    return word == wrong || word.starts_with(wrong + "=");
  });
  if (found == words.end()) return {};
  found->replace(0, wrong.size(), right);
  return words;
}

/// "unknown option '--jsn'; did you mean '--json'?"
UsageError UnknownName(const char* what, const std::string& typed,
                       const std::vector<std::string>& known, const std::string& command,
                       const std::vector<std::string>& words) {
  UsageError error{fmt::format("unknown {} '{}'", what, typed), command};
  const std::string near = grammar::NearestName(typed, known);
  if (near.empty()) return error;
  error.message += fmt::format("; did you mean '{}'?", near);
  error.corrected = Corrected(words, typed, near);
  return error;
}

UsageError UnexpectedWord(const CLI::App& app, const std::string& word, const std::string& command,
                          const std::vector<std::string>& words) {
  if (!word.starts_with('-')) return {fmt::format("unexpected argument '{}'", word), command};
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  return UnknownName("option", word.substr(0, word.find('=')), known, command, words);
}

/// What is wrong with the values of an option, or "".
std::string Problem(const Option& option, const std::vector<std::string>& values) {
  if (IsFlag(option)) {
    const bool plain =
        std::ranges::all_of(values, [](const auto& value) { return value == "true"; });
    return plain ? "" : option.name + " takes no value";
  }
  if (values.size() > 1 && !option.repeatable) return option.name + " is given more than once";
  for (const std::string& value : values) {
    if (value.empty()) return option.name + ": the value is empty";
    const std::string problem = option.rule.problem ? option.rule.problem(value) : "";
    if (!problem.empty()) return option.name + ": " + problem;
  }
  return "";
}

ParsedArguments Chosen(const Command& command, const CLI::App& app) {
  std::map<std::string, std::vector<std::string>> typed;
  for (const Option& option : command.options) {
    const CLI::Option* const parsed = app.get_option(option.name);
    const std::vector<std::string> values = parsed->results();
    if (const std::string problem = Problem(option, values); !problem.empty())
      return UsageError{problem, command.name};
    typed[option.name] = values;
  }
  return ChosenCommand{&command, ParsedOptions(std::move(typed))};
}

/// What CLI11 noticed itself, worded better where that can happen.
UsageError Worded(const CLI::ParseError& error, const Command* command) {
  const std::string message = error.what();
  if (!command) return {message};
  for (const Option& option : command->options) {
    if (message == option.name + " is required")
      return {fmt::format("the argument '{}' is missing", option.name), command->name};
    if (message.starts_with(option.name + ":") && message.ends_with(" missing"))
      return {
          fmt::format("{0}: the value is missing; write {0} {1}", option.name, option.placeholder),
          command->name};
  }
  return {message, command->name};
}

const Command* Find(const std::vector<Command>& commands, const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) return nullptr;
  return &*std::ranges::find(commands, chosen.front()->get_name(), &Command::name);
}

/// CLI11 puts two empty lines before each group of options.
std::string HelpOf(const CLI::App& app) {
  std::string help = app.help();
  for (std::size_t at; (at = help.find("\n\n\n")) != std::string::npos;) help.erase(at, 1);
  return help;
}

}  // namespace

ParsedArguments ParseArguments(const ProgramDescription& program,
                               const std::vector<Command>& commands,
                               const std::vector<std::string>& words) {
  CLI::App app(program.summary, "prehend");
  app.footer(program.footer);
  app.set_version_flag("--version", program.version, "Print the version and exit");
  app.allow_extras();
  for (const Command& command : commands) Declare(command, app);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them reversed
  } catch (const CLI::CallForVersion& version) {
    return InfoText{version.what() + std::string("\n")};
  } catch (const CLI::Success&) {
    return InfoText{HelpOf(app)};
  } catch (const CLI::ParseError& error) {
    return Worded(error, Find(commands, app));
  }
  const Command* const command = Find(commands, app);
  std::vector<std::string> extras = app.remaining(/*recurse=*/true);
  // CLI11 leaves over the word that ends the options.
  if (const auto end = std::ranges::find(extras, "--"); command && end != extras.end())
    extras.erase(end);
  if (command && extras.empty()) return Chosen(*command, *app.get_subcommand(command->name));
  if (command)
    return UnexpectedWord(*app.get_subcommand(command->name), extras.front(), command->name, words);
  if (extras.empty()) return InfoText{HelpOf(app), /*asked_for=*/false};
  if (extras.front().starts_with('-')) return UnexpectedWord(app, extras.front(), "", words);
  std::vector<std::string> names;
  for (const Command& known : commands) names.push_back(known.name);
  return UnknownName("command", extras.front(), names, "", words);
}

}  // namespace prehend::harness

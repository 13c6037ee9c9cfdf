// SPDX-License-Identifier: Apache-2.0
// CLI11 splits the words and prints the help; what is wrong with them is worded here.
#include "harness/cli/command/parse_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/base/base/quoting.h"

namespace prehend::cli {
namespace {

/// How wide a help is, and where its texts begin, which CLI11 decides.
constexpr std::size_t kHelpColumns = 100, kNameColumns = 30;

bool IsArgument(const Option& option) { return !option.name.starts_with('-'); }
bool IsFlag(const Option& option) { return !IsArgument(option) && option.placeholder.empty(); }

void Declare(const Option& option, CLI::App& app) {
  const std::string names =
      option.other_name.empty() ? option.name : option.name + "," + option.other_name;
  const std::string help = Wrapped(
      option.rule.range.empty() ? option.help : option.help + " (" + option.rule.range + ")",
      kHelpColumns - kNameColumns);
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
  if (option.unlisted) declared->group("");
}

void Declare(const Command& command, CLI::App& app) {
  std::string footer = "Examples:";
  for (const std::string& example : command.examples)
    footer += "\n  " + ProgramName() + " " + example;
  if (!command.note.empty()) footer += "\n\n" + command.note;
  app.footer(footer);
  app.allow_extras();
  app.set_help_flag("-h,--help")->group("");  // the program's help has it
  for (const Option& option : command.options) Declare(option, app);
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
                          const std::vector<OldName>& old_options,
                          const std::vector<std::string>& words) {
  if (!word.starts_with('-')) return {fmt::format("unexpected argument '{}'", word), command};
  const std::string typed = word.substr(0, word.find('='));
  const auto was = std::ranges::find(old_options, command + " " + typed, &OldName::old);
  if (was != old_options.end())
    return {fmt::format("'{}' is called '{}' now", typed, was->now), command,
            Corrected(words, typed, was->now)};
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  return UnknownName("option", typed, known, command, words);
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
UsageError Worded(const CLI::ParseError& error, const Command& command) {
  const std::string message = error.what();
  for (const Option& option : command.options) {
    if (message == option.name + " is required")
      return {fmt::format("the argument '{}' is missing", option.name), command.name};
    if (message.starts_with(option.name + ":") && message.ends_with(" missing"))
      return {
          fmt::format("{0}: the value is missing; write {0} {1}", option.name, option.placeholder),
          command.name};
  }
  return {message, command.name};
}

/// CLI11 puts two empty lines before each group of options.
std::string HelpOf(const CLI::App& app) {
  std::string help = app.help();
  for (std::size_t at; (at = help.find("\n\n\n")) != std::string::npos;) help.erase(at, 1);
  return help;
}

/// `words` after those of the command's name.
ParsedArguments ParseOptions(const Command& command, const std::vector<OldName>& old_options,
                             const std::vector<std::string>& words, std::ptrdiff_t words_of_name) {
  CLI::App app(command.summary, "prehend " + command.name);
  Declare(command, app);
  // CLI11 leaves over the word that ends the options.
  const auto extras = [&app] {
    std::vector<std::string> all = app.remaining();
    if (const auto end = std::ranges::find(all, "--"); end != all.end()) all.erase(end);
    return all;
  };
  try {
    // CLI11 takes them reversed.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend() - words_of_name));
  } catch (const CLI::Success&) {
    return InfoText{HelpOf(app)};
  } catch (const CLI::RequiredError& error) {
    if (extras().empty()) return Worded(error, command);
  } catch (const CLI::ParseError& error) {
    return Worded(error, command);
  }
  if (extras().empty()) return Chosen(command, app);
  return UnexpectedWord(app, extras().front(), command.name, old_options, words);
}

/// `typed`, the first word or the first two, names no command.
UsageError UnknownCommand(const ProgramDescription& program, const std::vector<Command>& commands,
                          const std::string& typed, const std::vector<std::string>& words) {
  const auto corrected = [&](const std::string& now) {
    std::vector<std::string> all(words.begin() + std::ranges::count(typed, ' ') + 1, words.end());
    const std::size_t space = now.find(' ');
    if (space != now.npos) all.insert(all.begin(), now.substr(space + 1));
    all.insert(all.begin(), now.substr(0, space));
    return all;
  };
  const std::string noun = typed.substr(0, typed.find(' '));
  for (const OldName& name : program.old_commands) {
    if (typed == name.old || (noun != typed && typed == noun + " " + name.old))
      return {fmt::format("'{}' is called '{}' now", typed, name.now), "", corrected(name.now)};
  }
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  for (const Noun& one : program.nouns) names.push_back(one.name);
  UsageError error{fmt::format("unknown command '{}'", typed), noun == typed ? "" : noun};
  const std::string near = grammar::NearestName(typed, names);
  if (near.empty()) return error;
  error.message += fmt::format("; did you mean '{}'?", near);
  error.corrected = corrected(near);
  return error;
}

/// The commands of a noun, by their second words.
std::vector<std::pair<std::string, const Command*>> CommandsOf(
    const Noun& noun, const std::vector<Command>& commands) {
  std::vector<std::pair<std::string, const Command*>> found;
  for (const Command& command : commands) {
    if (command.name.starts_with(noun.name + " "))
      found.emplace_back(command.name.substr(noun.name.size() + 1), &command);
  }
  return found;
}

std::string Line(const std::string& name, const std::string& summary) {
  return fmt::format("  {:<10} {}\n", name, summary);
}

/// One line per command in groups, and one per noun with the names of its commands.
std::string ProgramHelp(const ProgramDescription& program, const std::vector<Command>& commands) {
  std::string help = program.summary + "\nUsage: prehend COMMAND [OPTIONS]\n";
  for (const CommandGroup& group : program.groups) {
    help += "\n" + group.title + ":\n";
    for (const std::string& name : group.names)
      help += Line(name, std::ranges::find(commands, name, &Command::name)->summary);
  }
  if (!program.nouns.empty())
    help += "\nMore, as in '" + CommandText({program.nouns.front().name, "--help"}) + "':\n";
  for (const Noun& noun : program.nouns) {
    std::vector<std::string> names;
    for (const auto& [name, command] : CommandsOf(noun, commands)) names.push_back(name);
    help += Line(noun.name, fmt::format("{}: {}", noun.summary, fmt::join(names, ", ")));
  }
  return help + "\n" + program.footer + "\n";
}

/// One line for each command of the noun.
std::string NounHelp(const Noun& noun, const std::vector<Command>& commands) {
  std::string help = fmt::format("{}\nUsage: prehend {} COMMAND [OPTIONS]\n\nCommands:\n",
                                 noun.summary, noun.name);
  for (const auto& [name, command] : CommandsOf(noun, commands))
    help += Line(name, command->summary);
  return help + "\nEach has its own --help, as '" +
         CommandText({noun.name, CommandsOf(noun, commands).front().first, "--help"}) + "'\n";
}

bool IsHelp(const std::string& word) { return word == "-h" || word == "--help"; }

}  // namespace

ParsedArguments ParseArguments(const ProgramDescription& program,
                               const std::vector<Command>& commands,
                               const std::vector<std::string>& words) {
  if (words.empty()) return InfoText{ProgramHelp(program, commands), /*asked_for=*/false};
  std::string name = words.front();
  if (IsHelp(name)) return InfoText{ProgramHelp(program, commands)};
  if (name == "--version") return InfoText{program.version + "\n"};
  if (name.starts_with('-'))
    return UnknownName("option", name.substr(0, name.find('=')), {"--help", "--version"}, "",
                       words);
  const auto noun = std::ranges::find(program.nouns, name, &Noun::name);
  if (noun != program.nouns.end()) {
    if (words.size() == 1) return InfoText{NounHelp(*noun, commands), /*asked_for=*/false};
    if (IsHelp(words[1])) return InfoText{NounHelp(*noun, commands)};
    name += " " + words[1];
  }
  const auto command = std::ranges::find(commands, name, &Command::name);
  if (command == commands.end()) return UnknownCommand(program, commands, name, words);
  return ParseOptions(*command, program.old_options, words, noun == program.nouns.end() ? 1 : 2);
}

}  // namespace prehend::cli

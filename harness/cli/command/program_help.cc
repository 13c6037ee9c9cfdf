// SPDX-License-Identifier: Apache-2.0
// See harness/cli/command/program_help.h. Tested by tests/harness/cli/cli/command_tree_test.cc
#include "harness/cli/command/program_help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/base/base/shell_quote.h"

namespace prehend::cli {
namespace {

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

}  // namespace

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

std::string NounHelp(const Noun& noun, const std::vector<Command>& commands) {
  std::string help = fmt::format("{}\nUsage: prehend {} COMMAND [OPTIONS]\n\nCommands:\n",
                                 noun.summary, noun.name);
  for (const auto& [name, command] : CommandsOf(noun, commands))
    help += Line(name, command->summary);
  return help + "\nEach has its own --help, as '" +
         CommandText({noun.name, CommandsOf(noun, commands).front().first, "--help"}) + "'\n";
}

}  // namespace prehend::cli

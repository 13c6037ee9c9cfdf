// SPDX-License-Identifier: Apache-2.0
// Words of a command line -> the command that is meant and what was typed for its options, or a
// help text, or what is wrong. The only unit that knows CLI11. Tested by
// tests/harness/cli/command/parse_arguments_test.cc
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "harness/cli/command/command.h"

namespace prehend::cli {

/// A noun, the first word of several commands: "episode" of "episode list".
struct Noun {
  std::string name;
  std::string summary;
};

/// Commands under a heading of the program's help; nouns come below them.
struct CommandGroup {
  std::string title;
  std::vector<std::string> names;
};

/// What a command or an option was called once. It is no name any more: an error says the new one.
struct OldName {
  std::string old;
  std::string now;
};

/// What the program says about itself.
struct ProgramDescription {
  std::string version;  ///< all of `--version`
  std::string summary;
  std::string footer;  ///< below the list of commands
  std::vector<CommandGroup> groups = {};
  std::vector<Noun> nouns = {};
  std::vector<OldName> old_commands = {};
  std::vector<OldName> old_options = {};  ///< the old name with its command: "run --mesure"
};

/// A command to run. `command` is one of those that were given.
struct ChosenCommand {
  const Command* command = nullptr;
  ParsedOptions options;
};

/// A text to print instead of running a command: help or version.
struct InfoText {
  std::string text;
  bool asked_for = true;  ///< otherwise no command was typed
};

struct UsageError {
  std::string message;
  std::string command = {};                 ///< whose `--help` says more; "" is the program
  std::vector<std::string> corrected = {};  ///< the words with the mistake corrected, or empty
};

using ParsedArguments = std::variant<ChosenCommand, InfoText, UsageError>;

/// `words` are those after the program's name.
ParsedArguments ParseArguments(const ProgramDescription& program,
                               const std::vector<Command>& commands,
                               const std::vector<std::string>& words);

}  // namespace prehend::cli

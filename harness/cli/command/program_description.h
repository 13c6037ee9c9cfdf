// SPDX-License-Identifier: Apache-2.0
// What the program is called, how its commands are grouped, and what they were called once. Tested
// by tests/harness/cli/command/parse_arguments_test.cc
#pragma once

#include <string>
#include <vector>

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

}  // namespace prehend::cli

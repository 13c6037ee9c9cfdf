// SPDX-License-Identifier: Apache-2.0
// What `prehend --help` and `prehend NOUN --help` print. Tested by
// tests/harness/cli/cli/command_tree_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command/command.h"
#include "harness/cli/command/program_description.h"

namespace prehend::cli {

/// One line per command in groups, and one per noun with the names of its commands.
std::string ProgramHelp(const ProgramDescription& program, const std::vector<Command>& commands);

/// One line for each command of the noun.
std::string NounHelp(const Noun& noun, const std::vector<Command>& commands);

}  // namespace prehend::cli

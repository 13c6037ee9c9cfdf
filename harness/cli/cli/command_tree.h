// SPDX-License-Identifier: Apache-2.0
// All commands of `prehend`, and what the program says about itself: groups, nouns, old names.
// Tested by tests/harness/cli/cli/command_tree_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command/parse_arguments.h"

namespace prehend::cli {

std::vector<Command> AllCommands();
/// `version`: all that --version prints.
ProgramDescription DescribeProgram(const std::string& version);

}  // namespace prehend::cli

// SPDX-License-Identifier: Apache-2.0
// The command line: says what must hold before any command runs, dispatches to one, reports usage
// errors, prints help. Tested by tests/program/command_line_test.cc and
// tests/program/preconditions_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/base/exit_code.h"
#include "harness/cli/command/parse_arguments.h"

namespace prehend::cli {

/// All of `prehend`. `commit` follows the version where that is printed. Reads the environment:
/// PREHEND_HOME, PREHEND_COMMAND, CI, NO_COLOR.
ExitCode RunCommandLine(int argc, const char* const* argv, const char* commit);

std::vector<Command> AllCommands();
/// `version`: all that --version prints.
ProgramDescription DescribeProgram(const std::string& version);

}  // namespace prehend::cli

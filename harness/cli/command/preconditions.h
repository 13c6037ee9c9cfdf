// SPDX-License-Identifier: Apache-2.0
// What must hold before any command runs. Tested by tests/program/preconditions_test.cc
#pragma once

#include <optional>
#include <string>

#include "harness/base/base/exit_code.h"
#include "harness/cli/command/command.h"

namespace prehend::cli {

/// Why a command is not run at all.
struct Refusal {
  ExitCode exit_code = ExitCode::kBadInput;
  std::string reason;
};

/// The stack must be large enough for what the limits of files allow. Raises the limit of this
/// process if that is permitted.
std::optional<Refusal> RefuseSmallStack();

/// A folder of scenarios, goldens or libraries that cannot be read must not pass for an empty one.
std::optional<Refusal> RefuseUnreadableFolders(const std::string& root);

/// What a command writes (Option::is_output) must not replace what it reads, and must not lie among
/// the project's scenarios, goldens and libraries: people write these.
std::optional<Refusal> RefuseOutputsThatAreInputs(const std::string& root, const Command& command,
                                                  const ParsedOptions& options);

}  // namespace prehend::cli

// SPDX-License-Identifier: Apache-2.0
// A recording that was read or imported -> the file that was asked for. Tested by
// tests/program/import_test.cc
#pragma once

#include <string>

#include "harness/cli/command/command.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::cli {

/// Writes JSON Lines, or adds an episode where `output` is an episode file. `source`: what the
/// recording was read from. `grammar`: the one whose events the episode has; empty: its own. Prints
/// what is wrong.
ExitCode WriteRecording(episode::Recording& recording, const std::string& output,
                        const std::string& source, const std::string& grammar,
                        const CommandContext& context);

}  // namespace prehend::cli

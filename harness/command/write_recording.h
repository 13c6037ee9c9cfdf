// SPDX-License-Identifier: Apache-2.0
// A recording that was read or imported -> the file that was asked for. Tested by
// tests/program/import_test.cc
#pragma once

#include <string>

#include "harness/command/command.h"
#include "harness/sense/episode_file.h"

namespace prehend::harness {

/// Writes JSON Lines, or adds an episode where `output` is an episode file. `source`: what the
/// recording was read from. `grammar`: the one whose events the episode has; empty: its own. Prints
/// what is wrong.
ExitCode WriteRecording(Recording& recording, const std::string& output, const std::string& source,
                        const std::string& grammar, const CommandContext& context);

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// Whose doing a difference is: did the world move otherwise than in the last run that agreed with
// the golden, was it looked at otherwise, or did the grammar say something else about the same
// looks? Tested by
// tests/harness/check/blame_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/check/last_pass.h"
#include "harness/check/state_trace.h"

namespace prehend::harness {

/// A run, and what decided it.
struct Suspect {
  std::string program;  ///< ProgramHash()
  FileHashes inputs;
  std::vector<std::string> options;  ///< of its command line: "--grammar original_2020"
  bool other_grammar = false;        ///< one of them chose the grammar
  PhysicsTrace trace;
  double ticks_per_second = 480;
};

/// One line that begins with "blame: " and ends with a line feed. `root` shortens paths; without a
/// run that agreed the line says that there is nothing to compare with.
std::string BlameText(const std::optional<CheckRecord>& last_agreed,
                      const std::optional<PhysicsTrace>& its_trace, const Suspect& now,
                      const std::string& root);

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// Whose doing a difference is: did the world move otherwise than in the last run that agreed with
// the golden, or did the grammar say something else about the same motion? Tested by
// tests/harness/blame_test.cc
#pragma once

#include <optional>
#include <string>

#include "harness/check_records.h"
#include "harness/physics_trace.h"

namespace prehend::harness {

/// A run, and what decided it.
struct Suspect {
  std::string program;  ///< ProgramHash()
  FileHashes inputs;
  PhysicsTrace trace;
  double ticks_per_second = 480;
};

/// One line that begins with "blame: " and ends with a line feed. `root` shortens paths; without a
/// last pass the line says that there is nothing to compare with.
std::string BlameText(const std::optional<CheckRecord>& last_pass,
                      const std::optional<PhysicsTrace>& its_trace, const Suspect& now,
                      const std::string& root);

}  // namespace prehend::harness

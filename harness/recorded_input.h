// SPDX-License-Identifier: Apache-2.0
// Recorded motions as steps of a script: finds the files, cuts the recordings, and puts them where
// the scenario wants them. Tested by tests/harness/recorded_input_test.cc
#pragma once

#include <string>

#include "harness/complaints.h"
#include "harness/scenario_entries.h"
#include "harness/scenario_library.h"

namespace prehend::harness {

/// Fills in the poses of every recording step of the script; the files' paths start at the folder
/// of `scenario_file`. Complains about steps that don't fit their recording. What is wrong in a
/// recording, and warnings about it, go to `in_recordings`.
void ReadRecordings(const std::string& scenario_file, ScenarioEntry& entry,
                    const ScenarioLibrary& library, Complaints& complaints,
                    grammar::Diagnostics& in_recordings);

}  // namespace prehend::harness

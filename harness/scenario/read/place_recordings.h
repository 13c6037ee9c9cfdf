// SPDX-License-Identifier: Apache-2.0
// Recorded motions as steps of a script: finds the files, cuts the recordings, and puts them where
// the scenario wants them. Tested by tests/harness/scenario/read/place_recordings_test.cc
#pragma once

#include <string>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "harness/scenario/read/scenario_library.h"

namespace prehend::scenario {

/// Fills in the poses of every recording step of the script; the files' paths start at the folder
/// of `scenario_file`. Reports steps that do not fit their recording to `errors`; errors and
/// warnings inside a recording go to `in_recordings`.
void ReadRecordings(const std::string& scenario_file, ScenarioYaml& entry,
                    const ScenarioLibrary& library, DiagnosticList& errors,
                    grammar::Diagnostics& in_recordings);

}  // namespace prehend::scenario

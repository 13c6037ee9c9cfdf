// SPDX-License-Identifier: Apache-2.0
// Parts of a scenario that need more than a field table.
#pragma once

#include <string>
#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "harness/truth/claims/claim.h"

namespace prehend::scenario {

struct ScenarioLibrary;

// The claims of a scenario, from their texts. Which events and entities there are is checked when
// the grammar is known (harness/episode/run/load_run.h). Tested by
// tests/harness/scenario/read/read_claims_test.cc

/// Those that can be read; the others are reported at the letter that is wrong.
std::vector<truth::Claim> ReadClaims(const std::vector<Located<std::string>>& written,
                                     const YamlDocument& document, DiagnosticList& errors);

// Blocks of a script that are played several times: {repeat: 3, steps: [..]}. Tested by
// tests/harness/scenario/read/repeat_blocks_test.cc

/// The scenario with each block of its `script` written out, so often as it says; blocks may stand
/// in blocks. Reports blocks that are not well formed, or too many stages.
YamlNode WithoutRepeats(const YamlNode& scenario, DiagnosticList& errors);

// Recorded motions as steps of a script: finds the files, cuts the recordings, and puts them where
// the scenario wants them. Tested by tests/harness/scenario/read/place_recordings_test.cc

/// Fills in the poses of every recording step of the script; the files' paths start at the folder
/// of `scenario_file`. Reports steps that do not fit their recording to `errors`; errors and
/// warnings inside a recording go to `in_recordings`.
void ReadRecordings(const std::string& scenario_file, ScenarioYaml& entry,
                    const ScenarioLibrary& library, DiagnosticList& errors,
                    grammar::Diagnostics& in_recordings);

}  // namespace prehend::scenario

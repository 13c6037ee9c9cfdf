// SPDX-License-Identifier: Apache-2.0
// A small good scenario and a library that needs no files, for tests that break one thing at a
// time.
#pragma once

#include <string>

#include "harness/scenario/read/read_scenario.h"

namespace prehend::scenario {

/// Reads without complaints as file "probe.yaml".
extern const char* const kProbe;

/// Grammar pick_and_place; hands human_right and human_left with styles wrap (above, side) and
/// pinch (above).
ScenarioLibrary ProbeLibrary();

/// The probe with the only occurrence of `from` replaced.
std::string ProbeWith(const std::string& from, const std::string& to);

/// "line:column: message | hint" for each, one a line; "--set:1:2: ..." when it is not in the file.
std::string Brief(const grammar::Diagnostics& diagnostics);

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// The scenario format, version 1: every key, declared once. The reader and `prehend schema` both
// come from here; docs/scenario-format.md explains it to people. Tested by
// tests/harness/scenario_fields_test.cc
#pragma once

#include <string>

#include "harness/scenario_entries.h"

namespace prehend::harness {

/// Limits on the size of a scenario, so that a slip of the pen does not cost an hour.
inline constexpr std::size_t kMaxEntities = 10'000;
inline constexpr std::size_t kMaxActors = 16;
inline constexpr std::size_t kMaxBeats = 1'000;
inline constexpr std::size_t kMaxPoses = 10'000;  ///< in all steps together
inline constexpr std::size_t kMaxPictures = 32;
inline constexpr double kMaxDurationS = 3'600;

/// Built once: its schemas take longer to build than most scenarios take to read.
const Format<ScenarioEntry>& ScenarioFormat();

/// The JSON Schema (2020-12) of scenario files, for editors and validators, with a newline at its
/// end.
std::string ScenarioSchema();

}  // namespace prehend::harness

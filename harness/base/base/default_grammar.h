// SPDX-License-Identifier: Apache-2.0
// Which grammar segments the episode where none is named: a file of grammar/library/.
// Tested by tests/harness/scenario/read/read_scenario_test.cc
#pragma once

namespace prehend {

inline constexpr const char* kDefaultGrammar = "pick_and_place";

}  // namespace prehend

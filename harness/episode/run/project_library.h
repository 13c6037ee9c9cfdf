// SPDX-License-Identifier: Apache-2.0
// The grammars and hands that scenarios of a project can name. Tested by
// tests/harness/episode/run/find_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/read/scenario_library.h"

namespace prehend::episode {

/// Grammars and hands of the project. `files` receives the path of every hand that is read, and
/// must outlive the result.
scenario::ScenarioLibrary ProjectLibrary(const std::string& root,
                                         std::vector<std::string>* files = nullptr);

}  // namespace prehend::episode

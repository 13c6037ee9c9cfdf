// SPDX-License-Identifier: Apache-2.0
// The grammars and hands that scenarios of a project can name. Tested by
// tests/harness/run/find_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/read/scenario_library.h"

namespace prehend::harness {

/// Grammars and hands of the project. `files` receives the path of every hand that is read, and
/// must outlive the result.
ScenarioLibrary ProjectLibrary(const std::string& root, std::vector<std::string>* files = nullptr);

}  // namespace prehend::harness

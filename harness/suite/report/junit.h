// SPDX-License-Identifier: Apache-2.0
// Verdicts as JUnit XML, as continuous-integration servers read it (the schema of Jenkins' xUnit
// plug-in, junit-10.xsd). Tested by tests/harness/suite/report/junit_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/suite/check/verdict.h"

namespace prehend::suite {

/// Differences and pending goldens are failures, what could not be read or did not end is an error,
/// what nothing changed for is skipped. The class of a case is its skill.
std::string JunitXml(const std::vector<ScenarioVerdict>& verdicts);

}  // namespace prehend::suite

// SPDX-License-Identifier: Apache-2.0
// How this program was compiled. Tested by tests/harness/suite/check/attribute_run_test.cc and
// tests/program/golden_workflow_test.cc
#pragma once

#include <string>

namespace prehend {

/// Compiler, processor and flags: "GNU 12.2.0, x86_64, -O2". Another build may round differently.
std::string BuildText();

}  // namespace prehend

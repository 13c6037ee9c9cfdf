// SPDX-License-Identifier: Apache-2.0
// Whether a golden can be what its scenario's grammar says of it: events, roles, values and names
// that exist. What it expects otherwise is for `check` to find out. Tested by
// tests/program/golden_workflow_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/run/load_run.h"

namespace prehend::harness {

/// The golden of the scenario `id`, which was loaded as its file says.
grammar::Diagnostics CheckGoldenFile(const std::string& path, const std::string& id,
                                     const LoadedRun& loaded);

/// A file wherever it is: below golden/ it must be of the scenario that its place says, elsewhere
/// of the one that it names. `inputs` gets every path that was looked at.
grammar::Diagnostics CheckGoldenAlone(const std::string& path, const std::string& root,
                                      std::vector<std::string>& inputs);

}  // namespace prehend::harness

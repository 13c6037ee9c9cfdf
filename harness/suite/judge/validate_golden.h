// SPDX-License-Identifier: Apache-2.0
// Static checks of a golden: its events, roles, values and names exist in the scenario and its
// grammar. Whether they are recognised is up to `check`. Tested by
// tests/program/golden_workflow_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/run/load_run.h"

namespace prehend::suite {

/// The golden of the scenario `id`, loaded without changes.
grammar::Diagnostics ValidateGolden(const std::string& path, const std::string& id,
                                    const episode::LoadedRun& loaded);

/// A golden anywhere: below golden/ its place says of which scenario it is, elsewhere its header.
/// `inputs` gets every path that was read or looked for.
grammar::Diagnostics ValidateGoldenFile(const std::string& path, const std::string& root,
                                        std::vector<std::string>& inputs);

}  // namespace prehend::suite

// SPDX-License-Identifier: Apache-2.0
// prehend accept --pictures: the pictures of a scenario become goldens, its events stay as they
// are. Tested by tests/program/golden_workflow_test.cc
#pragma once

#include <string>

#include "harness/command/command.h"
#include "harness/golden/golden.h"
#include "harness/run/run_scenario.h"

namespace prehend::harness {

/// `golden` is the accepted one of the events; the reason is added to its header. `run` was
/// recorded.
ExitCode AcceptPictures(const CommandContext& context, const std::string& reason, Golden golden,
                        const Scenario& scenario, const RunResult& run);

}  // namespace prehend::harness

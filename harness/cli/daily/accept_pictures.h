// SPDX-License-Identifier: Apache-2.0
// prehend accept --pictures: the pictures of a scenario become goldens, its events stay as they
// are. Tested by tests/program/golden_workflow_test.cc
#pragma once

#include <string>

#include "harness/cli/command/command.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/truth/golden/golden.h"

namespace prehend::cli {

/// `golden` is the accepted one of the events; the reason is added to its header. `run` was
/// recorded.
ExitCode AcceptPictures(const CommandContext& context, const std::string& reason,
                        truth::Golden golden, const scenario::Scenario& scenario,
                        const episode::RunResult& run);

}  // namespace prehend::cli

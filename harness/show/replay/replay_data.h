// SPDX-License-Identifier: Apache-2.0
// A run as data for the 3D replay of the report page: shapes, colours, and where everything is at
// every tick, to less than a millimetre. Read by harness/suite/report/replay/replay.js. Tested by
// tests/harness/show/replay/replay_data_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::show {

/// Keys in docs/report-page.md. The run has a recording.
nlohmann::json ReplayJson(const scenario::Scenario& scenario, const episode::RunResult& run);

/// The same as text, deflated (RFC 1950), in base64; empty without a recording.
std::string ReplayData(const scenario::Scenario& scenario, const episode::RunResult& run);

}  // namespace prehend::show

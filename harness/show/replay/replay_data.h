// SPDX-License-Identifier: Apache-2.0
// A run as data for the 3D replay of the report page: shapes, colours, and where everything is at
// every tick, to less than a millimetre. Read by harness/suite/report/replay/replay.js. Tested by
// tests/harness/show/replay/replay_data_test.cc
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/base/pose.h"

namespace prehend::show {

/// Keys in docs/report-page.md. The run has a recording.
nlohmann::json ReplayJson(const scenario::Scenario& scenario, const episode::RunResult& run);

/// The same as text, deflated (RFC 1950), in base64; empty without a recording.
std::string ReplayData(const scenario::Scenario& scenario, const episode::RunResult& run);

/// How far an interpolated pose may be from the true one.
inline constexpr double kTrackTolerance_m = 0.0003;
inline constexpr double kTrackTolerance_rad = 0.006;

/// Indices of the poses that are kept, from the first to the last; of poses that are all the same,
/// the first. `at`: when each pose is, strictly increasing.
std::vector<std::size_t> KeysOf(std::span<const physics::Pose> poses,
                                std::span<const std::int64_t> at);

/// The pose between two others, `share` of the way.
physics::Pose Between(const physics::Pose& a, const physics::Pose& b, double share);

// When each step of a script was played, for a row beside the events. Tested by
// tests/harness/show/replay/played_steps_test.cc

struct PlayedStep {
  std::string who;   ///< a hand or a person
  std::string what;  ///< "reach milk"
  grammar::Tick begin = 0, end = 0;
};

/// In the order in which they began. Nothing without a recording of every tick. A step ends with
/// the next one of the same actor, or with its stage.
std::vector<PlayedStep> PlayedSteps(const scenario::Scenario& scenario,
                                    const episode::RunResult& run);

}  // namespace prehend::show

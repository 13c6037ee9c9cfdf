// SPDX-License-Identifier: Apache-2.0
// Limits on the size of a scenario, so that a typing error does not cost an hour. Tested by
// tests/harness/scenario/read/read_scenario_test.cc and
// tests/harness/scenario/format/scenario_errors_test.cc
#pragma once

#include <cstddef>

#include "physics/scene/run_limits.h"

namespace prehend::scenario {

/// How far from the origin a scenario may put or send anything.
inline constexpr double kMaxDistance_m = physics::kMaxDistance_m;

inline constexpr std::size_t kMaxEntities = 10'000;
inline constexpr std::size_t kMaxActors = 16;
inline constexpr std::size_t kMaxBeats = 1'000;
inline constexpr std::size_t kMaxStepsInARow = 200;  // of an actor in one stage
inline constexpr int kMaxRepeats = 100;
inline constexpr std::size_t kMaxPoses = 10'000;  ///< in all steps together
inline constexpr std::size_t kMaxPictures = 32;
inline constexpr std::size_t kMaxClaims = 64;
inline constexpr std::size_t kMaxClaimLength = 500;  ///< in bytes
inline constexpr double kMaxDuration_s = 3'600;
inline constexpr std::size_t kMaxVariations = 64;
inline constexpr std::size_t kMaxOutcomes = 16;

}  // namespace prehend::scenario

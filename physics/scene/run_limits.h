// SPDX-License-Identifier: Apache-2.0
// Plausibility limits of a run: a run that exceeds one is stopped and ends with a status. Tested by
// tests/physics/scene/run_limits_test.cc
#pragma once

#include <optional>
#include <string>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Largest distance from the origin. Objects that fell off the table exceed it after some time.
inline constexpr double kMaxDistance_m = 20;

struct RunProblem {
  std::string entity;
  std::string reason;
  std::string advice;
};

/// The first limit that is exceeded: bodies, then hands, then contacts.
std::optional<RunProblem> CheckSnapshot(const Scene& scene, const Snapshot& snapshot);

}  // namespace prehend::physics

// SPDX-License-Identifier: Apache-2.0
// Is the world still believable? A run that goes wrong is stopped and ends as a value.
// Tested by tests/physics/scene/run_limits_test.cc
#pragma once

#include <optional>
#include <string>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// From the origin. Things that fell past the table are far away by then.
inline constexpr double kMaxDistance_m = 20;

struct RunProblem {
  std::string entity;
  std::string reason;
  std::string advice;
};

/// The first thing that cannot be believed, bodies before hands before contacts.
std::optional<RunProblem> CheckSnapshot(const Scene& scene, const Snapshot& snapshot);

}  // namespace prehend::physics

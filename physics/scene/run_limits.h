// SPDX-License-Identifier: Apache-2.0
// Plausibility limits of a run: a run that exceeds one is stopped and ends with a status. Tested by
// tests/physics/scene/run_limits_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Largest distance from the origin. Objects that fell off the table exceed it after some time.
inline constexpr double kMaxDistance_m = 20;

/// The iterative solver does not converge if one of two bodies pressed together is so many times
/// heavier.
inline constexpr double kMaxMassRatio = 100;

/// The largest ratio of masses that press on each other at a contact and beside it: a heavy body
/// also presses a light one into a third.
double MassRatioAt(const Scene& scene, const Snapshot& snapshot, const ContactPoint& contact);
/// The hand or body.
const std::string& NameOf(const Scene& scene, const ContactSide& side);

/// A note that something went wrong is "physics: knife goes through board: ..".
inline constexpr std::string_view kLimitNote = "physics: ", kGoesThrough = " goes through ",
                                  kSinksInto = " sinks into ";
/// What a scenario that expects such a note says: "goes_through(knife, board)", "sinks_into(pot,
/// coaster)". "" of other notes.
std::string LimitOf(const std::string& note);

struct RunProblem {
  std::string entity;
  std::string reason;
  std::string advice;
};

/// The first limit that is exceeded: bodies, then hands, then contacts.
std::optional<RunProblem> CheckSnapshot(const Scene& scene, const Snapshot& snapshot);

}  // namespace prehend::physics

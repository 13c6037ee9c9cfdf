// SPDX-License-Identifier: Apache-2.0
// Where a contact point goes on. Engines keep a point where it is on a body, or move it over an
// edge or a corner as the normal turns; normals are of unit length. All arithmetic is written out,
// so that every processor guesses the same. Tested by tests/harness/episode/frames/frames_test.cc
#pragma once

#include <array>

#include "harness/episode/frames/rigid_motion.h"

namespace prehend::episode {

struct PlacedNormal {
  Vector3 p, n;
};

/// The component of a unit vector that the others determine best, and what it is then. `before`:
/// the vector that this one continues.
int LargestOf(const Vector3& n);
double LargestGuess(int largest, const Vector3& before, const Vector3& now);

/// How the place of a point is guessed.
enum class PlaceRule : int {
  kKept = 0,    ///< it stays where it is on its owner
  kRounded = 1  ///< it stays at a rounded edge, which the normal leaves elsewhere
};

/// By rule. `from`, `to`: poses of the owner in the two frames before; `outward`: 1 if the normal
/// points out of the owner, else -1.
std::array<Vector3, 2> PlacesFor(const PlacedNormal& before, const physics::Pose& from,
                                 const physics::Pose& to, double outward, const Vector3& n);

/// The rule that would have been right.
PlaceRule BestRule(const std::array<Vector3, 2>& places, const Vector3& found);

}  // namespace prehend::episode

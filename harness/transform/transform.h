// SPDX-License-Identifier: Apache-2.0
// The same story elsewhere: shifted, turned, mirrored, in another order. A verdict must not depend
// on it (metamorphic testing: T. Y. Chen et al., "Metamorphic testing: a review of challenges and
// opportunities", ACM Computing Surveys 51(1), 2018). Tested by
// tests/harness/transform/transform_test.cc
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "harness/scenario/scenario.h"

namespace prehend::harness {

enum class Transform {
  kNudge,      ///< everything 1 um along x: changes rounding only
  kShift,      ///< everything 1 mm along x
  kFar,        ///< everything 4 m along x and, unless planar, 2 m along y
  kTurn,       ///< by 37 degrees about the vertical
  kMirror,     ///< in the plane y = 0; right hands become left ones
  kReorder,    ///< entities are listed the other way round
  kBystander,  ///< a box lies asleep on a slab, 14 m away
};

struct TransformName {
  Transform transform;
  std::string_view name;  ///< as on the command line
  std::string_view help;
};
const std::vector<TransformName>& TransformNames();
std::string_view NameOf(Transform transform);

/// Those that move only rounding and the order of computations: a verdict that depends on them
/// rests on chaos.
const std::vector<Transform>& EnsembleTransforms();

/// The scenario so transformed. Its events, by the names of entities, are those of the original.
/// Otherwise why the two are not the same story.
tl::expected<Scenario, std::string> Transformed(const Scenario& scenario, Transform transform);

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// The same story elsewhere: shifted, turned, mirrored, in another order, under other names. A
// verdict must not depend on it (metamorphic testing: T. Y. Chen et al., "Metamorphic testing: a
// review of challenges and opportunities", ACM Computing Surveys 51(1), 2018). Tested by
// tests/harness/transform/transform_test.cc
#pragma once

#include <map>
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
  kRename,     ///< other names, which the alphabet has the other way round
  kCopies,     ///< a second copy of everything, 13 m away, does the same at the same time
  kRate,       ///< physics in steps half as long; what is watched, and when, stays
  kWatch,      ///< the grammar sees twice as many frames; physics stays
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

/// A scenario elsewhere, and what its entities are called in the original.
struct TransformedScenario {
  Scenario scenario;
  std::map<std::string, std::string> names;  ///< of the original, by the new one; who is not in it
                                             ///< was added
};

/// The scenario so transformed, whose events are those of the original. Otherwise why the two are
/// not the same story.
tl::expected<TransformedScenario, std::string> Transformed(const Scenario& scenario,
                                                           Transform transform);

}  // namespace prehend::harness

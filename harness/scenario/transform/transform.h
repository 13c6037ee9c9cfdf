// SPDX-License-Identifier: Apache-2.0
// Metamorphic transforms: changes of a scenario that move only rounding and the order of
// computations. A verdict that depends on them rests on chaos (metamorphic testing: T. Y. Chen et
// al., "Metamorphic testing: a review of challenges and opportunities", ACM Computing Surveys
// 51(1), 2018). Tested by tests/harness/scenario/transform/transform_test.cc
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "harness/scenario/scenario/scenario.h"

namespace prehend::scenario {

enum class Transform {
  kNudge,      ///< everything 1 um along x: changes rounding only
  kShift,      ///< everything 1 mm along x
  kFar,        ///< everything 4 m along x and, unless planar, 2 m along y
  kTurn,       ///< everything by 37 degrees about the vertical
  kReorder,    ///< entities are listed the other way round
  kBystander,  ///< a box lies asleep on a slab, 14 m away
};
inline constexpr std::array kTransforms = {Transform::kNudge,   Transform::kShift,
                                           Transform::kFar,     Transform::kTurn,
                                           Transform::kReorder, Transform::kBystander};
std::string_view NameOf(Transform transform);

/// The scenario so transformed, whose events are those of the original. Otherwise why the two are
/// not the same story.
tl::expected<Scenario, std::string> Transformed(Scenario scenario, Transform transform);

/// Why the scenario, turned or mirrored, is another story; "": it is not.
std::string WhyDirected(const Scenario& scenario);

/// Each place and direction in it, those of its script and its outcomes included, moved by `X`,
/// which turns about the vertical only.
Scenario Moved(Scenario scenario, const physics::Pose& X);

}  // namespace prehend::scenario

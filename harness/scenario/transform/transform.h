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
  kReorder,    ///< entities are listed the other way round
  kBystander,  ///< a box lies asleep on a slab, 14 m away
};
inline constexpr std::array kTransforms = {Transform::kNudge, Transform::kShift, Transform::kFar,
                                           Transform::kReorder, Transform::kBystander};
std::string_view NameOf(Transform transform);

/// The scenario so transformed, whose events are those of the original. Otherwise why the two are
/// not the same story.
tl::expected<Scenario, std::string> Transformed(Scenario scenario, Transform transform);

/// Each place in it, those of its script and its outcomes included, moved by `by_m`.
Scenario Shifted(Scenario scenario, const Eigen::Vector3d& by_m);

}  // namespace prehend::scenario

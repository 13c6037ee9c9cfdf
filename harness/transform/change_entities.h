// SPDX-License-Identifier: Apache-2.0
// The same scenario with its entities listed or called otherwise, or with others beside them.
// Tested by tests/harness/transform/transform_test.cc
#pragma once

#include <map>
#include <string>

#include "harness/scenario/scenario.h"

namespace prehend::harness {

/// All bodies the other way round, but those of persons, which are consecutive.
Scenario Reordered(Scenario scenario);

/// A new name for each body, hand and person, so that the alphabet has them the other way round.
std::map<std::string, std::string> NamesTurnedRound(const Scenario& scenario);

/// Every entity called as `names` says; those that are not in it keep their names. Not in `expects`
/// and `pictures`, which are about the scenario as it was written.
Scenario Renamed(Scenario scenario, const std::map<std::string, std::string>& names);

/// A box that lies asleep on a slab, 14 m away.
Scenario WithBystander(Scenario scenario);

/// The largest extent that a thing may have beside its copy.
inline constexpr double kMostExtentBesideCopy_m = 6;
/// A second copy of all bodies, hands and persons 13 m away along x, which does the same at the
/// same time.
Scenario WithCopy(Scenario scenario);

}  // namespace prehend::harness

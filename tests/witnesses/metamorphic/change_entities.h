// SPDX-License-Identifier: Apache-2.0
// The same scenario with its entities called otherwise, or with a copy of them beside them.
// Tested by tests/witnesses/metamorphic/metamorphic_test.cc
#pragma once

#include <map>
#include <string>

#include "harness/scenario/scenario/scenario.h"

namespace prehend::witnesses {

/// A new name for each body, hand and person, so that the alphabet has them the other way round.
std::map<std::string, std::string> NamesTurnedRound(const scenario::Scenario& scenario);

/// Every entity called as `names` says; those that are not in it keep their names. Not in `expects`
/// and `pictures`, which are about the scenario as it was written.
scenario::Scenario Renamed(scenario::Scenario scenario,
                           const std::map<std::string, std::string>& names);

/// The largest extent that a thing may have beside its copy.
inline constexpr double kMostExtentBesideCopy_m = 6;
/// A second copy of all bodies, hands and persons 13 m away along x, which does the same at the
/// same time.
scenario::Scenario WithCopy(scenario::Scenario scenario);

}  // namespace prehend::witnesses

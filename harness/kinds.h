// SPDX-License-Identifier: Apache-2.0
// Classes of entities and what they are kinds of: those that are built in, and those that a
// scenario writes. Tested by tests/harness/kinds_test.cc
#pragma once

#include "harness/complaints.h"
#include "harness/scenario_entries.h"

namespace prehend::harness {

/// Given to entities anyway; nobody may use the name for a class of their own.
bool IsBuiltInClass(const std::string& name);

/// Complains about kinds of themselves, and about classes that nothing is of.
void CheckKinds(const ScenarioEntry& entry, Complaints& complaints);

/// A class and all that it is a kind of, the most special first.
std::vector<std::string> WithKinds(const std::string& class_name,
                                   const std::vector<KindEntry>& kinds);

/// All classes of a body of the scenario, most special first: its own and its kinds, then those
/// that are built in.
std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body);

}  // namespace prehend::harness

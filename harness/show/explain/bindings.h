// SPDX-License-Identifier: Apache-2.0
// The bindings of a rule that could be meant where some of its roles are left open.
// Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <vector>

#include "grammar/replay_monitor.h"

namespace prehend::show {

inline constexpr std::size_t kMaxBindings = 64;

/// Those that were looked at while the episode went on; if there is none, those that could have
/// been. At most kMaxBindings. `wanted`: kNone for whoever.
std::vector<grammar::InstanceId> BindingsThatFit(grammar::ReplayMonitor& past, grammar::RuleId rule,
                                                 const grammar::Binding& wanted);

}  // namespace prehend::show

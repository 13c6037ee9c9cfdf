// SPDX-License-Identifier: Apache-2.0
// Which part of a run, and which of its events, a figure shows. Tested by
// tests/harness/figures/figures_test.cc
#pragma once

#include <string>

#include "harness/run/run_scenario.h"
#include "harness/scenario/scenario.h"

namespace prehend::harness::figures {

struct Window {
  double from_s = 0, to_s = 0;
  std::string hand = {};    ///< nothing of other hands; empty: all
  std::string entity = {};  ///< events in which it takes part; empty: all

  /// Whether it shows this event, whenever that is.
  bool Shows(const Scenario& scenario, const grammar::NamedEvent& event) const;
};
Window WholeOf(const RunResult& run);

/// The hand of a phase or a grasp, or "".
std::string HandOf(const RunResult& run, const grammar::NamedEvent& event);

double SecondsOf(const RunResult& run, grammar::Tick tick);

}  // namespace prehend::harness::figures

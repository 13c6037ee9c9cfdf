// SPDX-License-Identifier: Apache-2.0
// Which part of a run, and which of its events, a figure shows. Tested by
// tests/harness/show/figures/figures_test.cc
#pragma once

#include <string>

#include "harness/episode/run/run_scenario.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::show {

struct Window {
  double from_s = 0, to_s = 0;
  std::string hand = {};    ///< nothing of other hands; empty: all
  std::string entity = {};  ///< events in which it takes part; empty: all

  /// Whether it shows this event, whenever that is.
  bool Shows(const scenario::Scenario& scenario, const grammar::NamedEvent& event) const;
};
Window WholeOf(const episode::RunResult& run);

/// The hand of a phase or a grasp, or "".
std::string HandOf(const episode::RunResult& run, const grammar::NamedEvent& event);

double SecondsOf(const episode::RunResult& run, grammar::Tick tick);

}  // namespace prehend::show

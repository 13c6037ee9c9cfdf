// SPDX-License-Identifier: Apache-2.0
// The figures of the paper (Haidu and Beetz, arXiv 2011.13689) from runs of one's own: key frames,
// phases, time series of a plate that is carried, gaze. Tested by
// tests/harness/figures/figures_test.cc and tests/program/figure_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/figures/chart.h"
#include "harness/run/load_run.h"
#include "harness/run/run_scenario.h"
#include "harness/scenario/scenario.h"

namespace prehend::harness::figures {

/// The part of an episode that is shown, in seconds.
struct Window {
  double from_s = 0, to_s = 0;
};
Window WholeOf(const RunResult& run);

/// Moments that tell the story: the begins of what hands do, the end of the last of it, and in
/// between the middle of what takes longest; at most `most`, in the order of time.
struct KeyMoment {
  double time_s = 0;
  std::string caption;  ///< "reaching begins"
};
std::vector<KeyMoment> KeyMoments(const RunResult& run, const Window& window, std::size_t most);

/// All events: what each hand does, holds and touches; what stands on what.
Chart PhasesChart(const Scenario& scenario, const RunResult& run, const Window& window);

/// The rows of two segmentations of one episode in turn, each followed by the row of the same name
/// of the other one. `here` and `there` say whose they are.
Chart SideBySide(Chart chart, const std::string& here, const Chart& other,
                 const std::string& there);

/// What hands do, and over it per moving thing its height, per hand its trigger and the force with
/// which it touches things.
Chart SeriesChart(const Scenario& scenario, const RunResult& run, const Window& window);

/// What each person sees: a row per entity, the distance to it. Nothing if there is no person.
std::optional<Chart> GazeChart(const Scenario& scenario, const RunResult& run,
                               const Window& window);

/// A hand holds something in some style: when, and with which sensors.
struct HeldMoment {
  double time_s = 0;
  std::string style;
  std::vector<std::string> sensor_sets;  ///< that touch what is held, in the hand's order
};
/// The middle of the longest grasp that has a style.
std::optional<HeldMoment> LongestGrasp(const Scenario& scenario, const RunResult& run);

}  // namespace prehend::harness::figures

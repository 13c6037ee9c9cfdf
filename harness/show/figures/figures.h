// SPDX-License-Identifier: Apache-2.0
// The figures of the paper (Haidu and Beetz, arXiv 2011.13689) from runs of one's own: key frames,
// phases, time series of a plate that is carried, gaze. Tested by
// tests/harness/show/figures/figures_test.cc and tests/program/figure_test.cc
#pragma once

#include <optional>
#include <string>

#include "grammar/watch_drawing.h"
#include "harness/show/chart/chart.h"
#include "harness/show/figures/moments.h"

namespace prehend::show {

/// All events: what each hand does, holds and touches; what stands on what.
Chart PhasesChart(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const Window& window);

/// The rows of two segmentations of one episode in turn, each followed by the row of the same name
/// of the other one. `here` and `there` say whose they are.
Chart SideBySide(Chart chart, const std::string& here, const Chart& other,
                 const std::string& there);

/// What hands do, and below it per moving thing its height and tilt, per hand its trigger and the
/// force with which it touches things.
Chart SeriesChart(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const Window& window);
/// When its curves tell most, at most `count` moments in the order of time: begin, half and end of
/// the tilt; the greatest force; the greatest height.
std::vector<KeyMoment> SeriesMoments(const Chart& chart, std::size_t count);

/// What each person sees: a row per entity, the distance to it. Nothing if there is no person.
std::optional<Chart> GazeChart(const scenario::Scenario& scenario, const episode::RunResult& run,
                               const Window& window);

/// A drawn episode and what a grammar recognises in it, how a form of rule looks: rows of bars for
/// facts and events, panels of curves for positions and the like.
Chart DrawingChart(const grammar::Program& program, const grammar::DrawnEpisode& drawn,
                   const grammar::Timeline& timeline);

}  // namespace prehend::show

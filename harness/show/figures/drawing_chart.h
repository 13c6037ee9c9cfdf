// SPDX-License-Identifier: Apache-2.0
// A drawn episode and what a grammar recognises in it, as a chart: how a form of rule looks.
// Tested by tests/program/figure_test.cc
#pragma once

#include "grammar/watch_drawing.h"
#include "harness/show/chart/chart.h"

namespace prehend::show {

/// Rows of bars for facts and events, panels of curves for positions and the like.
Chart DrawingChart(const grammar::Program& program, const grammar::DrawnEpisode& drawn,
                   const grammar::Timeline& timeline);

}  // namespace prehend::show

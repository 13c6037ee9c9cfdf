// SPDX-License-Identifier: Apache-2.0
// The figures of the paper (Haidu and Beetz, arXiv 2011.13689) from runs of one's own: key frames,
// phases, time series of a plate that is carried, gaze. Tested by
// tests/harness/show/figures/figures_test.cc and tests/program/figure_test.cc
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "grammar/watch_drawing.h"
#include "harness/show/chart/chart.h"
#include "harness/show/figures/moments.h"
#include "harness/show/figures/scene_tiles.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"

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

// Two segmentations of one episode, or of one scenario in two physics engines: both over time, and
// the scene at each boundary that they do not agree about. Tested by
// tests/harness/show/figures/comparison_sheet_test.cc

/// A boundary that is at two times, or an event that only one side has or has otherwise.
struct BoundaryDifference {
  std::string boundary;  ///< "begin of reaching(right_hand, milk)", "reaching(right_hand, milk)"
  std::string how;       ///< "120.8 ms later", "0.41 to 1.05 s", "style: pinch -> wrap"
  std::vector<std::string> involved;  ///< hands and things of the event
  double first_s = 0, second_s = 0;
  double end_s = 0;  ///< of an event that only one side has
  bool first_has = true, second_has = true;

  bool HaveBoth() const { return first_has && second_has; }
  double Begin_s() const {
    return HaveBoth() ? std::min(first_s, second_s) : first_has ? first_s : second_s;
  }
  bool IsAtTheTimesOf(const BoundaryDifference& other) const {
    return HaveBoth() && other.HaveBoth() && first_s == other.first_s && second_s == other.second_s;
  }
};
/// Those that begin in the window, in the order of time. Boundaries that are at one time for both
/// sides are one.
std::vector<BoundaryDifference> BoundaryDifferences(const truth::Comparison& comparison,
                                                    const Window& window,
                                                    const scenario::Scenario& scenario);

/// More boundaries than these have no scenes; a note says how many.
inline constexpr std::size_t kMostDifferences = 8;

struct Side {
  std::string name;                            ///< "golden", "my_rules", "box2d"
  const episode::RunResult* events = nullptr;  ///< its timeline
  const episode::RunResult* scenes =
      nullptr;  ///< its recording, which may be the other side's, too
};

/// `comparison` has the first side as expected, the second one as actual. Two that agree are shown
/// at some of their key moments if their scenes are of different recordings. If a scene cannot be
/// drawn, the painter has the reason.
Sheet ComparisonSheet(const scenario::Scenario& scenario, const Side& first, const Side& second,
                      const truth::Comparison& comparison, const Window& window,
                      const SceneFormat& format, ScenePainter& painter);

/// Golden pictures of a scenario, the same as its run shows them now, and where they differ.
Sheet GoldenPicturesSheet(const std::string& id, const scenario::Scenario& scenario,
                          const episode::RunResult& run,
                          const std::vector<truth::KeptPicture>& goldens, ScenePainter& painter);

/// The chart of it alone.
Chart ComparisonChart(const scenario::Scenario& scenario, const Side& first, const Side& second,
                      const truth::Comparison& comparison, const Window& window);

}  // namespace prehend::show

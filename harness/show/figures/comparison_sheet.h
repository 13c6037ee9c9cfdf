// SPDX-License-Identifier: Apache-2.0
// Two segmentations of one episode, or of one scenario in two physics engines: both over time, and
// the scene at each boundary that they do not agree about. Tested by
// tests/harness/show/figures/comparison_sheet_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/show/figures/figures.h"
#include "harness/show/figures/scene_tiles.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"

namespace prehend::show {

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

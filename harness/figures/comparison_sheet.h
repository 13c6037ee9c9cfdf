// SPDX-License-Identifier: Apache-2.0
// Two segmentations of one episode, or of one scenario in two physics engines: both over time, and
// the scene at each boundary that they do not agree about. Tested by
// tests/harness/figures/comparison_sheet_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/figures/figures.h"
#include "harness/figures/scene_tiles.h"
#include "harness/golden/compare.h"
#include "harness/golden/golden_files.h"

namespace prehend::harness::figures {

/// More boundaries than these have no scenes; a note says how many.
inline constexpr std::size_t kMostDisputes = 8;

struct Side {
  std::string name;                   ///< "golden", "my_rules", "box2d"
  const RunResult* events = nullptr;  ///< its timeline
  const RunResult* scenes = nullptr;  ///< its recording, which may be the other side's, too
};

/// `comparison` has the first side as expected, the second one as actual. Two that agree are shown
/// at some of their key moments if their scenes are of different recordings. If a scene cannot be
/// drawn, the painter has the reason.
Sheet ComparisonSheet(const Scenario& scenario, const Side& first, const Side& second,
                      const Comparison& comparison, const Window& window, const SceneFormat& format,
                      ScenePainter& painter);

/// Golden pictures of a scenario, the same as its run shows them now, and where they differ.
Sheet GoldenPicturesSheet(const std::string& id, const Scenario& scenario, const RunResult& run,
                          const std::vector<KeptPicture>& goldens, ScenePainter& painter);

/// The chart of it alone.
Chart ComparisonChart(const Scenario& scenario, const Side& first, const Side& second,
                      const Comparison& comparison, const Window& window);

}  // namespace prehend::harness::figures

// SPDX-License-Identifier: Apache-2.0
// Scenes of a sheet, and the sheets that are made of one run. Tested by
// tests/harness/show/figures/scene_tiles_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "harness/show/figures/moments.h"
#include "harness/show/figures/sheet.h"
#include "harness/show/pictures/scene_painter.h"

namespace prehend::show {

/// Height of scenes beside a chart, their width being 1.
inline constexpr double kWideScene = 0.6;

struct SceneFormat {
  std::string camera = "action";
  PictureFormat picture;  ///< its size is that of the tile, its title is the caption
  ChartFormat chart;
};

/// Adds a scene to the row. Returns its PNG; if it cannot be drawn, the painter has the reason.
std::string AddScene(const scenario::Scenario& scenario, const episode::RunResult& run,
                     double time_s, const std::string& caption, const SceneFormat& format,
                     ScenePainter& painter, TileRow& row);

/// The format's camera as text (harness/scenario/scenario/own_camera.h) for scenes as wide as those
/// beside a chart. `action` is nearer than in pictures, which leave room for title and strip.
std::string WideView(const scenario::Scenario& scenario, const episode::RunResult& run,
                     double time_s, const SceneFormat& format);

/// The key moments with letters, on as many columns as there are, at most five.
Sheet KeyFrameSheet(const scenario::Scenario& scenario, const episode::RunResult& run,
                    const std::vector<KeyMoment>& moments, const SceneFormat& format,
                    ScenePainter& painter);

/// Scenes in a row above the chart, which says with letters when they are.
Sheet WithScenes(Chart chart, const scenario::Scenario& scenario, const episode::RunResult& run,
                 const std::vector<KeyMoment>& moments, const SceneFormat& format,
                 ScenePainter& painter);

/// The longest looks in the window, in the order of time: who sees what, for how long, how far it
/// is.
std::vector<KeyMoment> LongestLooks(const scenario::Scenario& scenario,
                                    const episode::RunResult& run, const Window& window,
                                    std::size_t most);

/// A run in which something is held.
struct HeldScene {
  const scenario::Scenario* scenario = nullptr;
  const episode::RunResult* run = nullptr;
  HeldMoment held;
};
/// What is held in which style, the hand's parts coloured by the sets of their sensors.
Sheet GraspSheet(const std::vector<HeldScene>& scenes, const SceneFormat& format,
                 ScenePainter& painter);

struct PlayedGrasp {
  episode::LoadedRun loaded;
  episode::RunResult run;
  HeldMoment held;
};

/// Of the first scenario, short ones first, in which a hand holds something in that style. Plays
/// only what may show a style that is not known yet.
Result<std::vector<PlayedGrasp>> FindGrasps(std::vector<episode::RunRequest> scenarios,
                                            const std::string& root);

/// They point to the grasps.
std::vector<HeldScene> ScenesOf(const std::vector<PlayedGrasp>& grasps);

}  // namespace prehend::show

// SPDX-License-Identifier: Apache-2.0
// Scenes of a sheet, and the sheets that are made of one run. Tested by
// tests/harness/show/figures/scene_tiles_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "harness/show/chart/chart.h"
#include "harness/show/figures/moments.h"
#include "harness/show/pictures/pictures.h"

namespace prehend::show {

// Scenes in rows, each with a caption, and a chart below them, as one SVG: what of it is a drawing
// stays a drawing, and scenes are PNGs in it. Tested by tests/harness/show/figures/sheet_test.cc

/// A scene with its caption.
struct Tile {
  std::string png;      ///< the bytes of a PNG file
  std::string caption;  ///< lines are broken where it says
};

/// Tiles that belong together, as many beside each other as there are columns.
struct TileRow {
  std::string heading = {};  ///< "begin of reaching(right_hand, milk)", or ""
  std::vector<Tile> tiles;
  int columns = 1;
  double height_share = 0.75;  ///< height of a scene, its width being 1
};

struct Sheet {
  std::string title = {};
  std::vector<TileRow> rows = {};
  std::optional<Chart> chart = {};
  bool chart_first = false;  ///< above the scenes
  std::string note = {};     ///< at the end
  std::vector<std::pair<std::string, std::uint32_t>> legend =
      {};  ///< what colours mean, at the end
};

/// How wide a scene is drawn, in pixels of the drawing.
double TileWidth(const ChartFormat& format, int columns);

std::string SheetSvg(const Sheet& sheet, const ChartFormat& format = {});

/// Drawings of one width in rows of so many.
std::string BesideEachOther(const std::vector<std::string>& svgs, const ChartFormat& format,
                            std::size_t columns);

/// "a", "b", .. "z", "aa", ..
std::string LetterOf(std::size_t number);

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

/// The format's camera as text (harness/scenario/scenario/scenario.h) for scenes as wide as those
/// beside a chart. `action` is nearer than in pictures, which leave room for title and strip.
std::string WideView(const scenario::Scenario& scenario, const episode::RunResult& run,
                     double time_s, const SceneFormat& format);

/// Adds the key moments with the next letters, and the ways of the hands that lead to them.
void AddKeyFrames(const scenario::Scenario& scenario, const episode::RunResult& run,
                  const std::vector<KeyMoment>& moments, const SceneFormat& format,
                  ScenePainter& painter, TileRow& row);

/// The same on as many columns as there are, at most five.
Sheet KeyFrameSheet(const scenario::Scenario& scenario, const episode::RunResult& run,
                    const std::vector<KeyMoment>& moments, const SceneFormat& format,
                    ScenePainter& painter);

/// Scenes above the chart, which says with letters when they are. `row` says how they are laid out;
/// of no columns: as is best.
Sheet WithScenes(Chart chart, const scenario::Scenario& scenario, const episode::RunResult& run,
                 const std::vector<KeyMoment>& moments, const SceneFormat& format,
                 ScenePainter& painter, TileRow row = {.columns = 0, .height_share = kWideScene});

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

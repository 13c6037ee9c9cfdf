// SPDX-License-Identifier: Apache-2.0
// Scenes in rows, each with a caption, and a chart below them, as one SVG: what of it is a drawing
// stays a drawing, and scenes are PNGs in it. Tested by tests/harness/show/figures/sheet_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/show/chart/chart.h"

namespace prehend::show {

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

/// "a", "b", .. "z", "aa", ..
std::string LetterOf(std::size_t number);

}  // namespace prehend::show

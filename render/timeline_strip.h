// SPDX-License-Identifier: Apache-2.0
// The strip at the bottom of a picture: events as named bars over time, with a playhead. The layout
// is computed first, because the camera frames the scene in the area that the strip leaves free.
// Tested by tests/render/timeline_strip_test.cc
#pragma once

#include <string>
#include <vector>

#include "render/image/canvas.h"
#include "render/picture.h"

namespace prehend::render {

enum class NamePlace { kNone, kInside, kAbove };

struct StripBar {
  std::string row;       ///< its label
  StripSegment segment;  ///< as in the row
  Rect rect;
  Color color;
  NamePlace name_place = NamePlace::kNone;
  std::string name;  ///< shortened if necessary
  float name_size_px = 0;
  float name_left = 0, name_top = 0;
};

/// One line of bars. A row with overlapping segments has several lanes.
struct StripLane {
  Rect track;
  std::string label;  ///< the row's label, on its first lane only
  std::vector<StripBar> bars;
};

struct StripTick {
  float x = 0;
  std::string label;  ///< empty: a minor tick
};

/// What a colour means, above the lanes.
struct StripKey {
  std::string name;
  Color color;
  Rect box;  ///< around swatch and name
};

struct StripLayout {
  float scale = 1;  ///< scale of all sizes; 1 at 720 pixel rows
  Rect panel;       ///< empty height: no strip
  float label_left = 0;
  float axis_top = 0;
  std::vector<StripLane> lanes;
  std::vector<StripKey> legend;  ///< of names that have no room at their bars
  std::vector<StripTick> ticks;
  float playhead_x = 0;  ///< NaN: outside
  std::string playhead_label;
  std::string note;         ///< how many rows are left out; below the rows' labels
  int reserved_px() const;  ///< pixel rows that the scene should leave free
  int picture_height_px = 0;
};

/// Size of text and spacing relative to a picture of 720 rows.
float OverlayScale(int height_px);

/// Omits the last rows if the strip would be higher than 42 % of the picture, and says how many.
StripLayout LayOutStrip(const TimelineStrip& strip, const Font& font, int width_px, int height_px,
                        float text_scale = 1);
void DrawStrip(const StripLayout& layout, Canvas* canvas);

}  // namespace prehend::render

// SPDX-License-Identifier: Apache-2.0
// What lies flat on a picture: title, labels, strip. It is laid out first, because the strip
// decides how much is left for the scene, and because an inventory names it without drawing it.
// Tested by tests/render/painter_test.cc, tests/render/inventory_test.cc
#pragma once

#include <string>
#include <vector>

#include "render/draw_list.h"
#include "render/image/canvas.h"
#include "render/inventory.h"
#include "render/picture.h"

namespace prehend::render {

// The strip at the bottom of a picture: events as named bars over time, with a playhead. The layout
// is computed first, because the camera frames the scene in the area that the strip leaves free.
// Tested by tests/render/timeline_strip_test.cc

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

// Names beside the objects of a picture, placed so that they overlap neither each other nor
// important content. Tested by tests/render/labels_test.cc

struct LabelRequest {
  std::string text;
  Color color;             ///< of the small bar beside the text
  Eigen::Vector2f anchor;  ///< of what is seen of the object, near its centre, pixels
  Rect extent;             ///< approximate area of the object in the picture
  std::string of = "";     ///< the object's name in the scene
};

struct PlacedLabel {
  LabelRequest request;
  Rect box;
};

/// Areas and points that labels avoid.
struct LabelObstacles {
  Rect area;                           ///< labels are inside
  std::vector<Rect> forbidden;         ///< title and similar
  std::vector<Eigen::Vector2f> avoid;  ///< points of paths; covering them is allowed at a cost
};

/// Placed labels in the order of the requests, without those that find no free place.
std::vector<PlacedLabel> PlaceLabels(const std::vector<LabelRequest>& requests,
                                     const LabelObstacles& obstacles, const Font& font,
                                     float scale);
void DrawLabels(const std::vector<PlacedLabel>& labels, float scale, Canvas* canvas);

struct Overlay {
  float scale = 1;
  Rect title_box;  ///< empty: no title
  std::string title;
  std::vector<PlacedLabel> labels;
  StripLayout strip;
  bool is_drawn = true;  ///< not on a picture so small that text would hide it
};

StripLayout LayOutStripOf(const Picture& picture, const Font& font);

/// The strip of *overlay is laid out already. `seen` has the index into list.objects of what is
/// seen at each pixel, or is empty.
void AddTitleAndLabels(const Picture& picture, const DrawList& list, const View& view,
                       const std::vector<std::uint32_t>& seen, const Font& font, Overlay* overlay);

void DrawOverlay(const Overlay& overlay, Canvas* canvas);

// The inventory of a drawn picture. Tested by tests/render/inventory_test.cc

/// `listed` has the image and, in `things`, indices into list.objects. The overlay's things are
/// added to them.
void ListThings(const DrawList& list, const Overlay& overlay, ListedPicture* listed);

}  // namespace prehend::render

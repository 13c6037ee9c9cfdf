// SPDX-License-Identifier: Apache-2.0
// What lies flat on a picture: title, labels, strip. It is laid out first, because the strip
// decides how much is left for the scene, and because an inventory names it without drawing it.
// Tested by tests/render/painter_test.cc, tests/render/inventory_test.cc
#pragma once

#include <string>
#include <vector>

#include "render/draw_list.h"
#include "render/labels.h"
#include "render/timeline_strip.h"
#include "render/view.h"

namespace prehend::render {

struct Overlay {
  float scale = 1;
  Rect title_box;  ///< empty: no title
  std::string title;
  std::vector<PlacedLabel> labels;
  StripLayout strip;
  bool is_drawn = true;  ///< not on a picture so small that text would hide it
};

StripLayout LayOutStripOf(const Picture& picture, const Font& font);

/// The strip of *overlay is laid out already.
void AddTitleAndLabels(const Picture& picture, const DrawList& list, const View& view,
                       const Font& font, Overlay* overlay);

void DrawOverlay(const Overlay& overlay, Canvas* canvas);

}  // namespace prehend::render

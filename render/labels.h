// SPDX-License-Identifier: Apache-2.0
// Names beside the objects of a picture, placed so that they overlap neither each other nor
// important content.
// Tested by tests/render/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "render/image/canvas.h"

namespace prehend::render {

struct LabelRequest {
  std::string text;
  Color color;             ///< of the small bar beside the text
  Eigen::Vector2f anchor;  ///< centre of the object, pixels
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

}  // namespace prehend::render

// SPDX-License-Identifier: Apache-2.0
// Names beside the things they belong to, placed so that they overlap neither each other nor what
// matters.
// Tested by tests/render/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"

namespace prehend::render {

struct LabelRequest {
  std::string text;
  Color color;             ///< of the small bar at its side
  Eigen::Vector2f anchor;  ///< where the thing is, pixels
  Rect extent;             ///< what it covers on the picture, roughly
};

struct PlacedLabel {
  LabelRequest request;
  Rect box;
};

/// What labels stay away from.
struct LabelObstacles {
  Rect area;                           ///< labels lie inside
  std::vector<Rect> forbidden;         ///< title and the like
  std::vector<Eigen::Vector2f> avoid;  ///< points of paths; covering them costs, but is allowed
};

/// In the order of the requests; one that finds no free place is left out.
std::vector<PlacedLabel> PlaceLabels(const std::vector<LabelRequest>& requests,
                                     const LabelObstacles& obstacles, const Font& font,
                                     float scale);
void DrawLabels(const std::vector<PlacedLabel>& labels, float scale, Canvas* canvas);

}  // namespace prehend::render

// SPDX-License-Identifier: Apache-2.0
#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prehend::render {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kTitleSize = 19;
constexpr int kMinSideWithText_px = 120;  // text would hide a smaller picture

float TextScale(const Picture& picture) {
  return std::isfinite(picture.text_scale) ? std::clamp(picture.text_scale, 0.3f, 5.0f) : 1;
}

float TitleSize(float scale) { return std::max(11.0f, kTitleSize * scale); }

// Large objects (tables) would leave no free place; for labels they count as scenery.
constexpr float kMaxExtentShare = 0.10f;  // of the picture's area

LabelRequest RequestLabel(const std::string& text, const Color& color, const Bounds& bounds,
                          const View& view) {
  LabelRequest request{text, color, Vector2f::Constant(std::nanf("")), {}};
  const std::optional<Vector2f> middle = ToPixel(view, bounds.center_m());
  if (bounds.empty() || !middle.has_value()) return request;
  request.anchor = *middle;
  Vector2f low = *middle, high = *middle;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3f far_side(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Vector3f p = bounds.low_m.array() + far_side * (bounds.high_m - bounds.low_m).array();
    const std::optional<Vector2f> pixel = ToPixel(view, p);
    if (!pixel.has_value()) return request;
    low = low.cwiseMin(*pixel);
    high = high.cwiseMax(*pixel);
  }
  const Vector2f size = high - low;
  const float area = static_cast<float>(view.width_px) * static_cast<float>(view.height_px);
  if (size.x() * size.y() < kMaxExtentShare * area)
    request.extent = {low.x(), low.y(), size.x(), size.y()};
  return request;
}

/// Where an object is seen, nearest to `wanted` and not at its edge; nowhere: `wanted`.
Vector2f SeenNear(const Vector2f& wanted, std::uint32_t object,
                  const std::vector<std::uint32_t>& seen, const View& view) {
  constexpr int kInside_px = 3;
  Vector2f nearest = wanted;
  float least = std::numeric_limits<float>::infinity();
  for (int y = kInside_px; !seen.empty() && y < view.height_px - kInside_px; ++y) {
    for (int x = kInside_px; x < view.width_px - kInside_px; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * view.width_px + x;
      if (seen[at] != object) continue;
      const Vector2f here(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const float away = (here - wanted).squaredNorm();
      const std::size_t row = static_cast<std::size_t>(kInside_px) * view.width_px;
      if (away < least && seen[at - row] == object && seen[at + row] == object &&
          seen[at - kInside_px] == object && seen[at + kInside_px] == object) {
        least = away;
        nearest = here;
      }
    }
  }
  return least < 1 ? wanted : nearest;
}

std::vector<LabelRequest> RequestLabels(const Picture& picture, const DrawList& list,
                                        const View& view, const std::vector<std::uint32_t>& seen) {
  std::vector<LabelRequest> requests;
  // Labels beyond `count` name objects that the scene does not have.
  const auto request = [&](const std::vector<std::string>& labels, std::size_t count,
                           int first_object, const auto& color_of, const auto& name_of) {
    for (std::size_t i = 0; i < std::min(labels.size(), count); ++i) {
      if (labels[i].empty()) continue;
      const std::size_t object = first_object + i;
      requests.push_back(RequestLabel(labels[i], color_of(i), list.objects[object].bounds, view));
      requests.back().anchor =
          SeenNear(requests.back().anchor, static_cast<std::uint32_t>(object), seen, view);
      requests.back().of = name_of(i);
    }
  };
  if (picture.scene == nullptr) return requests;
  request(
      picture.body_labels, picture.scene->bodies.size(), list.first_body,
      [&](std::size_t i) { return BodyColor(picture, i); },
      [&](std::size_t i) { return picture.scene->bodies[i].name; });
  request(
      picture.hand_labels, picture.scene->hands.size(), list.first_hand,
      [](std::size_t) { return kSkinColor; },
      [&](std::size_t i) { return picture.scene->hands[i].name; });
  return requests;
}

// Points along paths, so dense that no label fits between two.
std::vector<Vector2f> PathPixels(const DrawList& list, const View& view) {
  std::vector<Vector2f> pixels;
  for (const Item& item : list.paths) {
    if (item.primitive != Primitive::kMesh) continue;
    const Mesh& tube = list.meshes[static_cast<std::size_t>(item.mesh)];
    for (std::size_t i = 0; i < tube.vertices.size(); i += 13) {
      const std::optional<Vector2f> p = ToPixel(view, tube.vertices[i].corner);
      if (p.has_value()) pixels.push_back(*p);
    }
  }
  return pixels;
}

}  // namespace

StripLayout LayOutStripOf(const Picture& picture, const Font& font) {
  return LayOutStrip(picture.strip, font, picture.width_px, picture.height_px, TextScale(picture));
}

void AddTitleAndLabels(const Picture& picture, const DrawList& list, const View& view,
                       const std::vector<std::uint32_t>& seen, const Font& font, Overlay* overlay) {
  overlay->is_drawn = std::min(picture.width_px, picture.height_px) >= kMinSideWithText_px;
  if (!overlay->is_drawn) return;
  const float scale = OverlayScale(picture.height_px) * TextScale(picture);
  overlay->scale = scale;
  const auto width = static_cast<float>(picture.width_px),
             height = static_cast<float>(picture.height_px);
  const float size = TitleSize(scale);
  overlay->title = font.Shortened(picture.title, size, width - 56 * scale);
  if (!overlay->title.empty()) {
    overlay->title_box = {12 * scale, 12 * scale, font.Width(overlay->title, size) + 24 * scale,
                          size + 12 * scale};
  }
  const float free_height = height - static_cast<float>(overlay->strip.reserved_px());
  const LabelObstacles obstacles{.area = Rect{0, 0, width, free_height}.Grown(-5 * scale),
                                 .forbidden = {overlay->title_box.Grown(4 * scale)},
                                 .avoid = PathPixels(list, view)};
  overlay->labels = PlaceLabels(RequestLabels(picture, list, view, seen), obstacles, font, scale);
}

void DrawOverlay(const Overlay& overlay, Canvas* canvas) {
  if (!overlay.is_drawn) return;
  const float scale = overlay.scale;
  if (!overlay.title.empty()) {
    const Rect& box = overlay.title_box;
    canvas->FillRounded(box, 7 * scale, Hex(0xFFFFFF), 0.86f);
    canvas->DrawText(box.x + 12 * scale, box.y + 6 * scale, overlay.title, TitleSize(scale),
                     Hex(0x1B1F24));
  }
  DrawLabels(overlay.labels, scale, canvas);
  DrawStrip(overlay.strip, canvas);
}

}  // namespace prehend::render

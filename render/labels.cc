// SPDX-License-Identifier: Apache-2.0
// Greedy placement: every label takes the cheapest of all allowed places around its anchor. The
// cost is the distance plus what the label would cover; places above and beside the anchor are
// preferred to places below. The path of a hand: a tube for every interval, beads at fixed time
// steps (dense beads mean a slow hand) and an arrow in the middle. Intervals without a label (idle
// hands) are thin, without beads and arrow. Tested by tests/render/labels_test.cc and
// tests/render/draw_list_test.cc
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>

#include "render/draw_list.h"
#include "render/gl/mesh.h"
#include "render/overlay.h"

namespace prehend::render {
namespace {

using Eigen::Vector2f;

constexpr float kTextSize = 16;
constexpr float kMinText_px = 10;
constexpr int kDirections = 16;
constexpr float kDistances[] = {14, 28, 46, 70, 100, 140, 190, 250};
constexpr float kPerPixel = 0.4f;     // cost of a pixel of distance from the anchor
constexpr float kCoveredPoint = 5;    // cost of a path point under the label
constexpr float kCoveredThing = 110;  // of another object, if the label is entirely on it
constexpr float kCoveredSelf = 45;    // of its own object
constexpr float kCoveredAnchor = 40;  // of another object's anchor
constexpr float kCoveredLeader = 90;  // of a leader line that it covers or crosses
constexpr float kDownwards = 12;

float TextSize(float scale) { return std::max(kMinText_px, kTextSize * scale); }

bool Contains(const Rect& rect, const Vector2f& p) {
  return p.x() >= rect.x && p.x() <= rect.right() && p.y() >= rect.y && p.y() <= rect.bottom();
}

bool ContainsRect(const Rect& outer, const Rect& inner) {
  return inner.x >= outer.x && inner.y >= outer.y && inner.right() <= outer.right() &&
         inner.bottom() <= outer.bottom();
}

// The end of the leader line: the point of the label's edge that is nearest to the anchor.
Vector2f LeaderEnd(const Rect& box, const Vector2f& anchor) {
  return {std::clamp(anchor.x(), box.x, box.right()), std::clamp(anchor.y(), box.y, box.bottom())};
}

float Side(const Vector2f& a, const Vector2f& b, const Vector2f& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

bool Cross(const Vector2f& a, const Vector2f& b, const Vector2f& c, const Vector2f& d) {
  return Side(a, b, c) * Side(a, b, d) < 0 && Side(c, d, a) * Side(c, d, b) < 0;
}

bool Passes(const Vector2f& from, const Vector2f& to, const Rect& box) {
  const Vector2f low(box.x, box.y), high(box.right(), box.bottom());
  return Cross(from, to, low, high) || Cross(from, to, {low.x(), high.y()}, {high.x(), low.y()});
}

// Share of the label's area that is on the object, 0..1.
float CoveredShare(const Rect& box, const Rect& thing) {
  if (!box.Overlaps(thing)) return 0;
  const float width = std::min(box.right(), thing.right()) - std::max(box.x, thing.x);
  const float height = std::min(box.bottom(), thing.bottom()) - std::max(box.y, thing.y);
  return width * height / (box.width * box.height);
}

// Cost of a place; nullopt where the label must not be.
std::optional<float> Cost(const Rect& box, const LabelRequest& request,
                          const std::vector<LabelRequest>& requests,
                          const std::vector<PlacedLabel>& placed, const LabelObstacles& obstacles) {
  if (!ContainsRect(obstacles.area, box)) return std::nullopt;
  for (const Rect& rect : obstacles.forbidden) {
    if (box.Overlaps(rect)) return std::nullopt;
  }
  const Vector2f end = LeaderEnd(box, request.anchor);
  float cost =
      kPerPixel * (end - request.anchor).norm() + (box.y > request.anchor.y() ? kDownwards : 0);
  for (const PlacedLabel& other : placed) {
    if (box.Grown(5).Overlaps(other.box)) return std::nullopt;
    const Vector2f other_end = LeaderEnd(other.box, other.request.anchor);
    if (Passes(request.anchor, end, other.box)) return std::nullopt;
    if (Passes(other.request.anchor, other_end, box)) cost += kCoveredLeader;
    if (Cross(request.anchor, end, other.request.anchor, other_end)) cost += kCoveredLeader;
  }
  for (const LabelRequest& other : requests) {
    const bool self = &other == &request;
    cost += (self ? kCoveredSelf : kCoveredThing) * CoveredShare(box, other.extent);
    if (!self && Contains(box, other.anchor)) cost += kCoveredAnchor;
  }
  for (const Vector2f& p : obstacles.avoid) {
    if (Contains(box.Grown(4), p)) cost += kCoveredPoint;
  }
  return cost;
}

using Eigen::Vector3f;

constexpr float kTubeRadius_m = 0.0085f;
constexpr float kIdleRadius_m = 0.0045f;
constexpr float kBeadRadius_m = 0.0125f;
constexpr float kArrowRadius_m = 0.022f;
constexpr float kArrowLength_m = 0.050f;
constexpr double kBeadEvery_s = 0.2;
constexpr float kJoinGap_m = 0.05f;  // consecutive intervals are at most one sample apart
constexpr int kTubeSegments = 12;

std::vector<Vector3f> FinitePoints(const PathInterval& interval) {
  std::vector<Vector3f> points;
  for (const Vector3f& p : interval.points_m) {
    if (p.allFinite()) points.push_back(p);
  }
  return points;
}

// Points nearer than this to the previous one are skipped: they would only add the jitter of a
// resting hand to the tube's direction.
std::vector<Vector3f> Thinned(const std::vector<Vector3f>& points, float spacing_m) {
  std::vector<Vector3f> kept;
  for (const Vector3f& p : points) {
    if (kept.empty() || (p - kept.back()).norm() >= spacing_m) kept.push_back(p);
  }
  return kept;
}

std::string PlaceText(const Vector3f& p_W_m) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.3f, %.3f, %.3f)", p_W_m.x(), p_W_m.y(), p_W_m.z());
  return text;
}

float Length(const std::vector<Vector3f>& points) {
  float length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

void AddTube(const std::vector<Vector3f>& points, float radius, Item item, DrawList* list) {
  Mesh mesh = TubeMesh(points, kTubeSegments);
  if (mesh.triangles.empty()) return;
  item.primitive = Primitive::kMesh;
  item.mesh = static_cast<int>(list->meshes.size());
  item.half_size_m.setOnes();
  item.rounding_m = radius;
  list->meshes.push_back(std::move(mesh));
  AddItem(item, &list->paths, list);
}

void AddBeads(const PathInterval& interval, const std::vector<Vector3f>& points, float radius,
              Item item, DrawList* list) {
  item.primitive = interval.square_beads ? Primitive::kBox : Primitive::kBall;
  item.rounding_m = interval.square_beads ? 0.15f * radius : radius;
  if (interval.square_beads) item.half_size_m.setConstant(0.85f * radius);
  const double per_bead =
      std::isfinite(interval.points_per_s) ? interval.points_per_s * kBeadEvery_s : 0;
  const auto step = static_cast<std::size_t>(std::clamp(std::round(per_bead), 1.0, 1e6));
  Vector3f last = Vector3f::Constant(1e9f);
  for (std::size_t i = 0; i < points.size(); i += step) {
    if ((points[i] - last).norm() < 2.4f * radius) continue;
    last = points[i];
    item.X_WI = Eigen::Translation3f(last);
    AddItem(item, &list->paths, list);
  }
}

// The arrow points along the chord of its own length around the middle of the interval.
void AddArrow(const std::vector<Vector3f>& points, float scale, Item item, DrawList* list) {
  const float arrow_length = kArrowLength_m * scale;
  const float length = Length(points);
  if (length < 2 * arrow_length) return;
  float left = (length - arrow_length) / 2;
  for (std::size_t i = 1; i < points.size(); ++i) {
    left -= (points[i] - points[i - 1]).norm();
    if (left > 0) continue;
    std::size_t ahead = i;
    while (ahead + 1 < points.size() && (points[ahead] - points[i - 1]).norm() < arrow_length)
      ++ahead;
    const Vector3f direction = (points[ahead] - points[i - 1]).normalized();
    item.primitive = Primitive::kCone;
    item.X_WI = Eigen::Translation3f(points[i - 1]) * RotationBetween(Vector3f::UnitZ(), direction);
    item.half_size_m = Vector3f(kArrowRadius_m, kArrowRadius_m, kArrowLength_m) * scale;
    AddItem(item, &list->paths, list);
    return;
  }
}

}  // namespace

std::vector<PlacedLabel> PlaceLabels(const std::vector<LabelRequest>& requests,
                                     const LabelObstacles& obstacles, const Font& font,
                                     float scale) {
  std::vector<PlacedLabel> placed;
  const float height = TextSize(scale) + 6 * scale;
  for (const LabelRequest& request : requests) {
    if (request.text.empty() || !request.anchor.allFinite() ||
        !Contains(obstacles.area, request.anchor))
      continue;
    const float width = font.Width(request.text, TextSize(scale)) + 15 * scale;
    float best_cost = std::numeric_limits<float>::infinity();
    PlacedLabel best{request, {}};
    for (const float distance : kDistances) {
      for (int k = 0; k < kDirections; ++k) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / kDirections;
        const float away = distance * scale;
        const Vector2f toward(std::cos(angle), -std::sin(angle));
        // `away` is the distance from the anchor to the box's near edge, not to its middle.
        const Vector2f middle =
            request.anchor + toward * away + Vector2f(toward.x() * width, toward.y() * height) / 2;
        const Rect box = {std::round(middle.x() - width / 2), std::round(middle.y() - height / 2),
                          width, height};
        const std::optional<float> cost = Cost(box, request, requests, placed, obstacles);
        if (cost.has_value() && *cost < best_cost) {
          best_cost = *cost;
          best.box = box;
        }
      }
    }
    if (std::isfinite(best_cost)) placed.push_back(std::move(best));
  }
  return placed;
}

void DrawLabels(const std::vector<PlacedLabel>& labels, float scale, Canvas* canvas) {
  const Color ink = Hex(0x30363D);
  for (const PlacedLabel& label : labels) {
    const Vector2f anchor = label.request.anchor;
    canvas->DrawLine(anchor, LeaderEnd(label.box, anchor), std::max(1.0f, 1.4f * scale), ink, 0.8f);
    const float dot = std::max(4.0f, 5 * scale);
    canvas->FillRounded({anchor.x() - dot / 2, anchor.y() - dot / 2, dot, dot}, dot / 2, ink, 0.9f);
  }
  for (const PlacedLabel& label : labels) {
    const Rect& box = label.box;
    canvas->FillRounded(box, 5 * scale, Hex(0xFFFFFF), 0.88f);
    canvas->FillRounded({box.x + scale, box.y + 3 * scale, 3 * scale, box.height - 6 * scale},
                        1.5f * scale, label.request.color);
    const float size = TextSize(scale);
    const float top = box.y + (box.height - 1.3f * canvas->font().Ascent(size)) / 2;
    canvas->DrawText(box.x + 8 * scale, top, label.request.text, size, Hex(0x1B1F24));
  }
}

void AddPath(const std::vector<PathInterval>& path, float scale, DrawList* list) {
  Vector3f end_before = Vector3f::Constant(1e9f);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PathInterval& interval = path[i];
    const std::vector<Vector3f> points = FinitePoints(interval);
    list->objects.push_back({"path:" + std::to_string(i) + ":" + interval.label, {}});
    if (points.empty()) continue;
    list->objects.back().note =
        PlaceText(points.front()) + " to " + PlaceText(points.back()) + " m";

    const bool idle = interval.label.empty();
    const float radius = (idle ? kIdleRadius_m : kTubeRadius_m) * scale;
    std::vector<Vector3f> joined = points;
    if ((points.front() - end_before).norm() < kJoinGap_m)
      joined.insert(joined.begin(), end_before);
    const std::vector<Vector3f> thinned = Thinned(joined, 0.4f * radius);
    end_before = points.back();

    const Item item{.color = interval.color,
                    .gloss = 0.35f,
                    .object = static_cast<int>(list->objects.size()) - 1};
    AddTube(thinned, radius, item, list);
    if (idle) continue;
    AddBeads(interval, points, kBeadRadius_m * scale, item, list);
    AddArrow(thinned, scale, item, list);
  }
}

}  // namespace prehend::render

// SPDX-License-Identifier: Apache-2.0
// The path of a hand: a tube for every interval, beads at fixed time steps (dense beads mean a slow
// hand) and an arrow in the middle. Intervals without a label (idle hands) are thin, without beads
// and arrow.
// Tested by tests/render/draw_list_test.cc
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/draw_list.h"
#include "render/gl/mesh.h"

namespace prehend::render {
namespace {

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

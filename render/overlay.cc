// SPDX-License-Identifier: Apache-2.0
#include "render/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "render/draw_list.h"
#include "render/gl/gl_objects.h"

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

// Greedy placement: every label takes the cheapest of all allowed places around its anchor. The
// cost is the distance plus what the label would cover; places above and beside the anchor are
// preferred to places below. The path of a hand: a tube for every interval, beads at fixed time
// steps (dense beads mean a slow hand) and an arrow in the middle. Intervals without a label (idle
// hands) are thin, without beads and arrow. Tested by tests/render/labels_test.cc and
// tests/render/draw_list_test.cc

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

std::string ColorText(const Color& color) {
  const auto byte = [](float c) { return std::lround(255 * std::clamp(c, 0.0f, 1.0f)); };
  char text[8];
  std::snprintf(text, sizeof text, "#%02lx%02lx%02lx", byte(color.x()), byte(color.y()),
                byte(color.z()));
  return text;
}

std::string LookOf(const DrawnObject& object) {
  if (!object.color) return "";
  std::string look = ColorText(*object.color);
  if (object.alpha < 1) look += " " + std::to_string(std::lround(100 * object.alpha)) + " %";
  if (!object.note.empty()) look += ", " + object.note;
  return look;
}

std::string TimesText(const StripSegment& segment) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f..%.3f s", segment.begin_s, segment.end_s);
  return text;
}

/// The numbers of intervals, ghosts and marks are left out: one more would rename all that follow.
std::string WithoutNumber(const std::string& name) {
  const std::size_t first = name.find(':');
  const std::string kind = name.substr(0, first);
  if (kind != "path" && kind != "ghost" && kind != "marker") return name;
  const std::size_t second = name.find(':', first + 1);
  const std::string what = name.substr(second + 1);
  return kind == "marker" ? "mark:" + what : kind + ":" + (what.empty() ? "idle" : what);
}

class Lister {
 public:
  explicit Lister(ListedPicture* listed) : listed_(*listed) {
    listed_.inventory.width_px = listed_.image.width_px;
    listed_.inventory.height_px = listed_.image.height_px;
  }

  void Add(std::string name, std::string look) {
    std::ranges::replace(name, ' ', '_');
    const int number = ++seen_[name];
    if (number > 1) name += ":" + std::to_string(number);
    listed_.inventory.list.push_back({.name = std::move(name), .look = std::move(look)});
  }

  /// The thing that was added last covers the rectangle.
  void Cover(const Rect& rect) {
    const int width = listed_.image.width_px, height = listed_.image.height_px;
    const auto bound = [](float x, int limit) {
      return static_cast<int>(std::clamp(std::round(x), 0.0f, static_cast<float>(limit)));
    };
    const auto id = static_cast<std::uint32_t>(listed_.inventory.list.size() - 1);
    for (int y = bound(rect.y, height); y < bound(rect.bottom(), height); ++y) {
      const auto row = listed_.things.begin() + static_cast<std::ptrdiff_t>(y) * width;
      std::fill(row + bound(rect.x, width), row + bound(rect.right(), width), id);
    }
  }

  /// Counts pixels and finds boxes, after all have been added.
  void Measure() {
    Inventory& inventory = listed_.inventory;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < listed_.things.size(); ++i) {
      const std::uint32_t id = listed_.things[i];
      hash = (hash ^ id) * 0x100000001b3 + 1;
      hash ^= hash >> 29;
      ListedThing& thing = inventory.list[id];
      const int x = static_cast<int>(i) % inventory.width_px,
                y = static_cast<int>(i) / inventory.width_px;
      if (thing.pixels++ == 0) {
        thing.left = x;
        thing.top = y;
      }
      thing.left = std::min(thing.left, x);
      thing.right = std::max(thing.right, x + 1);
      thing.bottom = y + 1;
    }
    inventory.things = hash;
  }

 private:
  ListedPicture& listed_;
  std::map<std::string, int> seen_;
};

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

void ListThings(const DrawList& list, const Overlay& overlay, ListedPicture* listed) {
  Lister lister(listed);
  for (const DrawnObject& object : list.objects)
    lister.Add(WithoutNumber(object.name), LookOf(object));
  if (overlay.is_drawn) {
    for (const PlacedLabel& label : overlay.labels) {
      lister.Add("label:" + label.request.of, label.request.text);
      lister.Cover(label.box);
    }
    if (!overlay.title.empty()) {
      lister.Add("title", overlay.title);
      lister.Cover(overlay.title_box);
    }
    if (overlay.strip.panel.height > 0) {
      lister.Add("strip", overlay.strip.playhead_label);
      lister.Cover(overlay.strip.panel);
    }
    for (const StripLane& lane : overlay.strip.lanes) {
      for (const StripBar& bar : lane.bars) {
        lister.Add("bar:" + bar.row + ":" + bar.segment.label,
                   TimesText(bar.segment) + " " + ColorText(bar.color));
        lister.Cover(bar.rect);
      }
    }
  }
  lister.Measure();
}

}  // namespace prehend::render

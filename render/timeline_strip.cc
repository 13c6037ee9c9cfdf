// SPDX-License-Identifier: Apache-2.0
// Layout of the strip: every row is distributed to lanes (first free lane), names are inside or
// above their bars, ticks are at round seconds. Tested by tests/render/timeline_strip_test.cc
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include "render/overlay.h"

namespace prehend::render {
namespace {

// Sizes in pixels, for a picture of 720 pixel rows.
constexpr float kMargin = 12;
constexpr float kPadding = 10;
constexpr float kBarHeight = 18;
constexpr float kLanePitch = 23;
constexpr float kNameHeight = 15;  // room for names above the bars of a lane
constexpr float kAxisHeight = 20;
constexpr float kLegendHeight = 20;
constexpr float kRowText = 15, kBarText = 14, kSmallText = 12;
constexpr float kMinStripText_px = 9;
constexpr float kMaxHeightShare = 0.42f;
constexpr std::size_t kMaxLanes = 4;
constexpr std::size_t kEndOfLabel = 9;  // bytes of a long one: "_1 on"
constexpr float kMaxDrift = 0.3f;       // of a name above its bar, as a share of its width

struct TimeAxis {
  double begin_s = 0, end_s = 1;
  float left = 0, right = 1;
  float At(double t_s) const {
    return left + (right - left) *
                      static_cast<float>(std::clamp((t_s - begin_s) / (end_s - begin_s), 0.0, 1.0));
  }
};

bool IsVisible(const StripSegment& segment, const TimelineStrip& strip) {
  return segment.begin_s <= segment.end_s && segment.end_s >= strip.begin_s &&
         segment.begin_s <= strip.end_s;
}

// Puts each segment into the first lane that is free at its time, or into the last lane if none is.
std::vector<std::vector<StripSegment>> SplitIntoLanes(const StripRow& row,
                                                      const TimelineStrip& strip) {
  std::vector<StripSegment> segments;
  std::copy_if(row.segments.begin(), row.segments.end(), std::back_inserter(segments),
               [&](const StripSegment& segment) { return IsVisible(segment, strip); });
  std::stable_sort(
      segments.begin(), segments.end(),
      [](const StripSegment& a, const StripSegment& b) { return a.begin_s < b.begin_s; });
  std::vector<std::vector<StripSegment>> lanes(1);
  for (StripSegment& segment : segments) {
    auto lane = std::find_if(lanes.begin(), lanes.end(), [&](const auto& taken) {
      return taken.empty() || taken.back().end_s <= segment.begin_s + 1e-9;
    });
    if (lane == lanes.end() && lanes.size() < kMaxLanes) lane = lanes.emplace(lanes.end());
    if (lane == lanes.end()) lane = std::prev(lanes.end());
    lane->push_back(std::move(segment));
  }
  return lanes;
}

// Places the name inside the bar if it fits, at a smaller size if necessary; otherwise above, as
// near to the bar as other names allow.
void PlaceName(const StripSegment& segment, const Font& font, const TimeAxis& axis, float scale,
               float* above_taken, StripBar* bar) {
  if (segment.label.empty()) return;
  bar->name = segment.label;
  const float small = std::max(kMinStripText_px, kSmallText * scale);
  for (const float size : {std::max(kMinStripText_px, kBarText * scale), small}) {
    const float width = font.Width(segment.label, size);
    if (width > bar->rect.width - 6 * scale) continue;
    bar->name_place = NamePlace::kInside;
    bar->name_size_px = size;
    bar->name_left = bar->rect.x + (bar->rect.width - width) / 2;
    return;
  }
  const float width = font.Width(segment.label, small);
  const float middle = bar->rect.x + bar->rect.width / 2;
  const float wanted = middle - width / 2;
  const float left = std::max(*above_taken, std::min(wanted, axis.right - width));
  // A name beside its bar would be read as that of the next one.
  if (std::abs(left - wanted) <= kMaxDrift * width && left + width <= axis.right + 1) {
    bar->name_place = NamePlace::kAbove;
    bar->name_size_px = small;
    bar->name_left = left;
    *above_taken = left + width + 6 * scale;
    return;
  }
  bar->name = font.Shortened(segment.label, small, bar->rect.width - 4 * scale);
  if (bar->name.size() < 5) return;  // an ellipsis has three bytes; a name of one letter is useless
  bar->name_place = NamePlace::kInside;
  bar->name_size_px = small;
  bar->name_left = bar->rect.x + (bar->rect.width - font.Width(bar->name, small)) / 2;
}

StripLane MakeLane(const std::string& row, const std::vector<StripSegment>& segments,
                   const Font& font, const TimeAxis& axis, float scale) {
  StripLane lane;
  lane.track = {axis.left, 0, axis.right - axis.left, kBarHeight * scale};
  float above_taken = axis.left;
  for (const StripSegment& segment : segments) {
    const float begin = axis.At(segment.begin_s), end = axis.At(segment.end_s);
    StripBar bar{.row = row,
                 .segment = segment,
                 .rect = {begin, 0, std::max(2.0f, end - begin), kBarHeight * scale},
                 .color = segment.color};
    if (bar.rect.width > 6) bar.rect = {begin + 0.5f, 0, bar.rect.width - 1, bar.rect.height};
    PlaceName(segment, font, axis, scale, &above_taken, &bar);
    lane.bars.push_back(std::move(bar));
  }
  return lane;
}

bool HasNameAbove(const StripLane& lane) {
  return std::any_of(lane.bars.begin(), lane.bars.end(),
                     [](const StripBar& bar) { return bar.name_place == NamePlace::kAbove; });
}

float LaneHeight(const StripLane& lane, float scale) {
  return (kLanePitch + (HasNameAbove(lane) ? kNameHeight : 0)) * scale;
}

// Sets the y of all lanes from `top` downwards; returns the y of the axis.
float StackLanes(float top, float scale, const Font& font, std::vector<StripLane>* lanes) {
  float y = top;
  for (StripLane& lane : *lanes) {
    const float bar_top = y + (HasNameAbove(lane) ? kNameHeight * scale : 0);
    lane.track.y = bar_top;
    for (StripBar& bar : lane.bars) {
      bar.rect.y = bar_top;
      // Centres the ascent: letters without descenders then look centred.
      const float inside = bar_top + (bar.rect.height - 1.32f * font.Ascent(bar.name_size_px)) / 2;
      bar.name_top = bar.name_place == NamePlace::kAbove ? y + scale : inside;
    }
    y += LaneHeight(lane, scale);
  }
  return y;
}

std::string Seconds(double t_s, double step_s) {
  char text[32];
  const int decimals = step_s >= 1 ? 0 : step_s >= 0.1 ? 1 : 2;
  std::snprintf(text, sizeof text, "%.*f s", decimals, t_s);
  return text;
}

// The smallest round step with enough space between labels.
double TickStep(const TimeAxis& axis, float scale) {
  const double shortest_s = 64 * scale / (axis.right - axis.left) * (axis.end_s - axis.begin_s);
  const double decade = std::pow(10, std::floor(std::log10(shortest_s)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= shortest_s) return factor * decade;
  }
  return 10 * decade;
}

std::vector<StripTick> MakeTicks(const TimeAxis& axis, float scale) {
  constexpr int kMinorPerMajor = 5;
  const double step_s = TickStep(axis, scale), minor_s = step_s / kMinorPerMajor;
  std::vector<StripTick> ticks;
  const double first = std::ceil(axis.begin_s / minor_s - 1e-6),
               last = std::floor(axis.end_s / minor_s + 1e-6);
  for (int i = 0; i <= last - first; ++i) {
    const double number = first + i;
    const bool major = std::fmod(std::abs(number), kMinorPerMajor) < 0.5;
    ticks.push_back({axis.At(number * minor_s), major ? Seconds(number * minor_s, step_s) : ""});
  }
  return ticks;
}

bool LacksItsName(const StripBar& bar) {
  return bar.name_place == NamePlace::kNone || bar.name != bar.segment.label;
}

// What a colour means, for names that have no room at some bar, if the colour means one thing only.
void AddLegend(const TimelineStrip& strip, const Font& font, float scale, StripLayout* layout) {
  std::vector<StripKey> keys;
  for (const StripLane& lane : layout->lanes) {
    for (const StripBar& bar : lane.bars) {
      const auto same = std::ranges::find(keys, bar.segment.label, &StripKey::name);
      if (LacksItsName(bar) && same == keys.end())
        keys.push_back({.name = bar.segment.label, .color = bar.color});
    }
  }
  std::erase_if(keys, [&](const StripKey& key) {
    return key.name.empty() || std::ranges::any_of(strip.rows, [&](const StripRow& row) {
             return std::ranges::any_of(row.segments, [&](const StripSegment& segment) {
               return segment.color == key.color && segment.label != key.name;
             });
           });
  });
  const float size = std::max(kMinStripText_px, kSmallText * scale);
  float left = layout->lanes.front().track.x;
  for (StripKey& key : keys) {
    const float width = size + 5 * scale + font.Width(key.name, size);
    if (left + width > layout->lanes.front().track.right()) break;
    key.box = {left, 0, width, size};
    left += width + 14 * scale;
    layout->legend.push_back(key);
  }
  // Where the legend says it, a crowd of names above bars only confuses.
  for (StripLane& lane : layout->lanes) {
    for (StripBar& bar : lane.bars) {
      const bool is_crowded = bar.name_place == NamePlace::kAbove || LacksItsName(bar);
      if (is_crowded && std::ranges::find(layout->legend, bar.segment.label, &StripKey::name) !=
                            layout->legend.end())
        bar.name_place = NamePlace::kNone;
    }
  }
}

float WidestLabel(const TimelineStrip& strip, const Font& font, float size_px) {
  float widest = 0;
  for (const StripRow& row : strip.rows) widest = std::max(widest, font.Width(row.label, size_px));
  return widest;
}

void DrawLane(const StripLayout& layout, const StripLane& lane, Canvas* canvas) {
  const float s = layout.scale;
  canvas->FillRounded(lane.track, 3 * s, Hex(0xDCE1E7), 0.85f);
  const float text_size = std::max(kMinStripText_px, kRowText * s);
  const float label_top =
      lane.track.y + (lane.track.height - 1.32f * canvas->font().Ascent(text_size)) / 2;
  canvas->DrawText(layout.label_left, label_top, lane.label, text_size, Hex(0x1B1F24));
  for (const StripBar& bar : lane.bars) {
    canvas->FillRounded(bar.rect, 3 * s, bar.color);
    if (bar.name_place == NamePlace::kNone) continue;
    const Color ink = bar.name_place == NamePlace::kInside ? TextColorOn(bar.color) : Hex(0x1B1F24);
    canvas->DrawText(bar.name_left, bar.name_top, bar.name, bar.name_size_px, ink);
  }
}

void DrawAxis(const StripLayout& layout, const Rect& playhead_label, Canvas* canvas) {
  const float s = layout.scale, size = std::max(kMinStripText_px, kSmallText * s);
  const Color ink = Hex(0x59636E);
  for (const StripTick& tick : layout.ticks) {
    const float length = (tick.label.empty() ? 3.5f : 7.0f) * s;
    canvas->DrawLine({tick.x, layout.axis_top}, {tick.x, layout.axis_top + length},
                     std::max(1.0f, s), ink, 0.9f);
    if (tick.label.empty()) continue;
    const float width = canvas->font().Width(tick.label, size);
    const float left = std::min(tick.x - width / 2, layout.panel.right() - width - 4 * s);
    const Rect box = {left, layout.axis_top + 8 * s, width, size};
    if (!box.Grown(3 * s).Overlaps(playhead_label))
      canvas->DrawText(left, box.y, tick.label, size, ink);
  }
}

}  // namespace

int StripLayout::reserved_px() const {
  return panel.height > 0 ? picture_height_px - static_cast<int>(panel.y) : 0;
}

float OverlayScale(int height_px) {
  return std::clamp(static_cast<float>(height_px) / 720, 0.62f, 4.0f);
}

StripLayout LayOutStrip(const TimelineStrip& strip, const Font& font, int width_px, int height_px,
                        float text_scale) {
  const float scale = OverlayScale(height_px) * text_scale;
  StripLayout layout{.scale = scale, .picture_height_px = height_px};
  constexpr double kMaxSpan_s = 1e7;
  const double duration_s = strip.end_s - strip.begin_s;
  if (strip.rows.empty() || !(duration_s > 1e-3 && duration_s < kMaxSpan_s) ||
      !(std::abs(strip.begin_s) < kMaxSpan_s)) {
    return layout;
  }
  const float text_size = std::max(kMinStripText_px, kRowText * scale);
  const auto width = static_cast<float>(width_px), height = static_cast<float>(height_px);
  const float note_width =
      strip.rows_left_out > 0 ? font.Width("+ 100 more", kSmallText * scale) : 0;
  const float label_width =
      std::min(std::max(WidestLabel(strip, font, text_size), note_width), 0.2f * width);
  layout.label_left = (kMargin + kPadding + 2) * scale;
  const TimeAxis axis{strip.begin_s, strip.end_s, layout.label_left + label_width + 14 * scale,
                      width - (kMargin + 2 * kPadding) * scale};
  if (axis.right - axis.left < 100) return layout;

  const float frame_height = (kMargin + 2 * kPadding + kAxisHeight) * scale;
  float used = frame_height;
  std::size_t shown = 0;
  for (const StripRow& row : strip.rows) {
    std::vector<StripLane> lanes;
    float row_height = 0;
    for (const auto& segments : SplitIntoLanes(row, strip)) {
      lanes.push_back(MakeLane(row.label, segments, font, axis, scale));
      row_height += LaneHeight(lanes.back(), scale);
    }
    if (used + row_height > kMaxHeightShare * height) break;
    used += row_height;
    ++shown;
    lanes.front().label = font.Shortened(row.label, text_size, label_width + 1, kEndOfLabel);
    std::move(lanes.begin(), lanes.end(), std::back_inserter(layout.lanes));
  }
  if (layout.lanes.empty()) return layout;
  const std::size_t left_out = strip.rows.size() - shown + std::max(strip.rows_left_out, 0);
  if (left_out > 0) layout.note = "+ " + std::to_string(left_out) + " more";

  AddLegend(strip, font, scale, &layout);
  const float legend_height = layout.legend.empty() ? 0 : kLegendHeight * scale;
  used = frame_height + legend_height;
  for (const StripLane& lane : layout.lanes) used += LaneHeight(lane, scale);
  layout.panel = {kMargin * scale, height - used, width - 2 * kMargin * scale,
                  used - kMargin * scale};
  const float top = layout.panel.y + kPadding * scale;
  for (StripKey& key : layout.legend) key.box.y = top;
  layout.axis_top = StackLanes(top + legend_height, scale, font, &layout.lanes);
  layout.ticks = MakeTicks(axis, scale);
  const bool inside = strip.playhead_s >= strip.begin_s && strip.playhead_s <= strip.end_s;
  layout.playhead_x = inside ? axis.At(strip.playhead_s) : std::numeric_limits<float>::quiet_NaN();
  layout.playhead_label = inside ? Seconds(strip.playhead_s, 0.01) : "";
  return layout;
}

void DrawStrip(const StripLayout& layout, Canvas* canvas) {
  if (!(layout.panel.height > 0)) return;
  const float s = layout.scale, size = std::max(kMinStripText_px, kSmallText * s);
  canvas->FillRounded(layout.panel, 8 * s, Hex(0xFFFFFF), 0.86f);
  for (const StripKey& key : layout.legend) {
    const Rect swatch = {key.box.x, key.box.y + 1.5f * s, key.box.height, key.box.height};
    canvas->FillRounded(swatch, 2 * s, key.color);
    canvas->DrawText(key.box.x + size + 5 * s, key.box.y, key.name, size, Hex(0x1B1F24));
  }
  for (const StripLane& lane : layout.lanes) DrawLane(layout, lane, canvas);

  const float width = canvas->font().Width(layout.playhead_label, size) + 10 * s;
  const float left =
      std::clamp(layout.playhead_x - width / 2, layout.panel.x + 2 * s,
                 std::max(layout.panel.x + 2 * s, layout.panel.right() - width - 2 * s));
  const Rect tag = {left, layout.axis_top + 6 * s, width, size + 5 * s};
  const bool has_playhead = !layout.playhead_label.empty();
  DrawAxis(layout, has_playhead ? tag : Rect{}, canvas);
  canvas->DrawText(layout.label_left, layout.axis_top + 8 * s, layout.note, size, Hex(0x1B1F24));
  if (!has_playhead) return;
  const Color ink = Hex(0x15181C);
  canvas->DrawLine({layout.playhead_x, layout.panel.y + 2 * s}, {layout.playhead_x, tag.y + 2 * s},
                   std::max(1.5f, 2 * s), ink);
  canvas->FillRounded(tag, 4 * s, ink);
  canvas->DrawText(tag.x + 5 * s, tag.y + 2 * s, layout.playhead_label, size, Hex(0xFFFFFF));
}

}  // namespace prehend::render

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "render/overlay.h"

namespace prehend::render {
namespace {

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

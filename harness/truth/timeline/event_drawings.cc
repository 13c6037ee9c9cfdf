// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/timeline/event_drawings.h"

#include <algorithm>
#include <array>

namespace prehend::truth {
namespace {

// Told apart by people who are colour-blind: M. Okabe and K. Ito, "Color universal design", 2008.
constexpr std::array<std::uint32_t, 6> kPalette = {0x0072B2, 0xE69F00, 0x009E73,
                                                   0xCC79A7, 0x56B4E9, 0xD55E00};

EventDrawing DrawingOf(const grammar::EventSignature& event, std::size_t& next_color) {
  EventDrawing drawing{.as = event.drawing.as, .ghost = event.drawing.ghost};
  drawing.color =
      event.drawing.color ? *event.drawing.color : kPalette[next_color++ % kPalette.size()];
  const auto hand = std::ranges::find(event.classes, "Hand");
  drawing.hand = static_cast<std::size_t>(hand - event.classes.begin());
  const bool holds = drawing.as == grammar::DrawnAs::kGrasp;
  drawing.first = holds && drawing.hand == 0 ? 1 : 0;
  drawing.last = 1;
  return drawing;
}

}  // namespace

EventDrawings::EventDrawings(const grammar::Program& program) {
  std::size_t next_color = 0;
  for (const grammar::EventSignature& event : EventSignatures(program))
    drawings_[event.name] = DrawingOf(event, next_color);
  for (auto& [name, drawing] : drawings_) drawing.regions = grammar::RegionsOf(program, name);
}

const EventDrawing& EventDrawings::Of(std::string_view event) const {
  static const EventDrawing kUnknown;
  const auto found = drawings_.find(event);
  return found == drawings_.end() ? kUnknown : found->second;
}

}  // namespace prehend::truth

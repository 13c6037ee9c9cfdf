// SPDX-License-Identifier: Apache-2.0
// How the events of a grammar are drawn in pictures and reports: what its `drawn` clauses say, and
// a colour of a palette for each event that names none. Tested by
// tests/harness/truth/timeline/event_drawings_test.cc
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/contents.h"

namespace prehend::truth {

struct EventDrawing {
  grammar::DrawnAs as = grammar::DrawnAs::kRow;
  std::uint32_t color = 0x7A828C;  ///< 0xRRGGBB
  grammar::Ghost ghost = grammar::Ghost::kAtBegin;
  std::size_t hand = 0;   ///< of a phase or grasp: which role is the hand
  std::size_t first = 0;  ///< of a grasp: which role is held; of a support: which one stands
  std::size_t last = 0;   ///< of a support: on which one it stands
  std::vector<grammar::RegionOfInterest> regions = {};  ///< that its rule asks about
};

class EventDrawings {
 public:
  using ByEvent = std::map<std::string, EventDrawing, std::less<>>;

  EventDrawings() = default;  ///< no event is known
  explicit EventDrawings(ByEvent drawings) : drawings_(std::move(drawings)) {}
  explicit EventDrawings(const grammar::Program& program);

  /// Of an event that the grammar does not have: a grey row.
  const EventDrawing& Of(std::string_view event) const;

  const ByEvent& all() const { return drawings_; }

 private:
  ByEvent drawings_;
};

}  // namespace prehend::truth

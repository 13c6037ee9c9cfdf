// SPDX-License-Identifier: Apache-2.0
// How an event is drawn in pictures and reports: what `drawn` says in a grammar. It changes nothing
// of what is recognised.
#pragma once

#include <cstdint>
#include <optional>

namespace prehend::grammar {

enum class DrawnAs : std::uint8_t {
  kRow,      ///< a row of its own, as an event that says nothing
  kNothing,  ///< no row in pictures
  kPhase,    ///< what a hand does: colours its path, stands in the hand's row, has a ghost
  kGrasp,    ///< a hand holds something: a row below the hand's, and a ghost shows it, too
  kSupport,  ///< the first role stands on the second: a row of the first, a mark below it
};

enum class Ghost : std::uint8_t { kAtBegin, kAtEnd, kNoGhost };

struct Drawing {
  DrawnAs as = DrawnAs::kRow;
  std::optional<std::uint32_t> color;  ///< 0xRRGGBB
  Ghost ghost = Ghost::kAtBegin;       ///< of a phase
};

}  // namespace prehend::grammar

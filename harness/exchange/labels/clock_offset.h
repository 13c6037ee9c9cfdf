// SPDX-License-Identifier: Apache-2.0
// Videos and trackers begin at different times: labels that are all too early, or all too late.
// Tested by tests/harness/exchange/labels/labels_test.cc
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "grammar/base/timeline.h"

namespace prehend::exchange {

/// Labels that are found: something of the same name and roles shares half of the union with them.
struct ClockOffset {
  double offset_s = 0;  ///< to be added to the times of the labels
  int found_now = 0, found_then = 0, all = 0;
};

/// Of recordings, each with its labels and what was recognised, the offset of up to 5 s with which
/// the most labels are found. Nothing if that are hardly more than now.
std::optional<ClockOffset> FindClockOffset(
    std::span<const std::pair<grammar::Timeline, grammar::Timeline>> recordings);

}  // namespace prehend::exchange

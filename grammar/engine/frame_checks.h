// SPDX-License-Identifier: Apache-2.0
// Why a frame cannot be watched; empty when it can. Bodies of messages, no places: the caller knows
// what the frame is from. Tested by tests/grammar/monitor_test.cc
#pragma once

#include <string_view>

#include "grammar/base/frame.h"
#include "grammar/state/history.h"

namespace prehend::grammar {

/// Far enough from the limits of a Tick that times can be added and subtracted.
inline constexpr Tick kLatestTick = 1'000'000'000'000'000;

std::string_view WhyNoTick(Tick tick, const History& history);
/// `entities`: how many there are in the episode.
std::string_view WhyNotWatchable(const Frame& frame, int entities);
std::string_view WhyNotWatchable(const FrameChanges& changes, int entities);

}  // namespace prehend::grammar

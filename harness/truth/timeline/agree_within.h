// SPDX-License-Identifier: Apache-2.0
// Agreement with definitions whose numbers have bands: several timelines are true. Tested by
// tests/harness/truth/timeline/agree_within_test.cc
#pragma once

#include <span>

#include "harness/truth/timeline/match_events.h"

namespace prehend::truth {

/// How well a timeline agrees with the timelines that the definitions allow; the first has the
/// definitions' own numbers.
/// - Found events that some of them have match. A boundary between the earliest and the latest of
///   theirs has no offset: the match's `truth` has it where it was found. Otherwise `truth` has the
///   nearer of the two.
/// - An event that none of them has is extra.
/// - An event of the first is missing if each of the others lacks a partner for one there, too. One
///   that is not longer than the collar may lie between two frames: it is not missed.
Agreement AgreeWithin(std::span<const grammar::Timeline> possible, const grammar::Timeline& found,
                      grammar::Tick collar);

}  // namespace prehend::truth

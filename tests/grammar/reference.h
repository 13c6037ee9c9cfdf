// SPDX-License-Identifier: Apache-2.0
// The meaning table of docs/grammar-language.md as code: slow, obvious, and over whole episodes at once. It shares
// nothing with the engine but the words.
#pragma once

#include <vector>

#include "grammar/frame.h"

namespace prehend::grammar::reference {

/// Truth per frame.
using Stream = std::vector<bool>;

/// Frames [begin, end); end == number of frames: it lasts until the end of the episode.
struct Run {
  int begin = 0;
  int end = 0;
  friend bool operator==(const Run&, const Run&) = default;
};
using Runs = std::vector<Run>;

/// Ticks of all frames, and after them the end of the episode.
using Ticks = std::vector<Tick>;

Stream And(const Stream& a, const Stream& b);
Stream Or(const Stream& a, const Stream& b);
Stream Not(const Stream& a);
/// True inside the runs.
Stream Truth(const Runs& runs, int frames);
/// True where a run begins; where one ends.
Stream Begins(const Runs& runs, int frames);
Stream Ends(const Runs& runs, int frames);

/// Maximal runs; gaps of at most `bridging` ticks are closed.
Runs While(const Stream& f, const Ticks& ticks, Tick bridging);
/// True from where `on` holds, without `off`, until `off` holds.
Stream Hold(const Stream& on, const Stream& off);
/// `from .. to .. within`: what has not ended in time is dropped.
Runs FromToWithin(const Stream& from, const Stream& to, const Stream& during, bool or_drop, const Ticks& ticks, Tick within);
/// `from .. without .. within`: in ticks, since a deadline may lie between two frames.
std::vector<Interval> FromWithout(const Stream& from, const Stream& without, const Stream& during, const Ticks& ticks,
                                  Tick within);
Runs FromTo(const Stream& from, const Stream& to, const Stream& during, bool or_drop);
Runs UntilSince(const Stream& until, const Stream& since, const Ticks& ticks, Tick back);
Runs RestOf(const Runs& whole, const std::vector<Stream>& outside);

Runs Lasting(const Runs& runs, const Ticks& ticks, Tick lasting);
Runs ConfirmedBy(const Runs& runs, const Runs& by, const Stream& within);

}  // namespace prehend::grammar::reference

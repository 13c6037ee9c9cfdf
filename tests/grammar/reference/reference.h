// SPDX-License-Identifier: Apache-2.0
// The meaning table of docs/grammar-language.md as code: slow, obvious, and over whole episodes at
// once. It shares nothing with the engine but the words.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::grammar::reference {

/// Truth per frame.
using Stream = std::vector<bool>;
/// In three values: where it is true, and where it is not false. Unknown is one of them.
struct Truths {
  Stream is, may;
};

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
/// Kleene's.
Truths And(const Truths& a, const Truths& b);
Truths Or(const Truths& a, const Truths& b);
Truths Not(const Truths& a);
/// True inside the runs.
Stream Truth(const Runs& runs, int frames);
/// True where a run begins; where one ends.
Stream Begins(const Runs& runs, int frames);
Stream Ends(const Runs& runs, int frames);

/// Maximal runs; gaps of at most `bridging` ticks are closed.
Runs While(const Stream& f, const Ticks& ticks, Tick bridging);
/// Truth per frame, as it is for an interval that begins (of `until`: ends) at a frame.
struct Anchored {
  Anchored(Stream fixed)
      : at([fixed = std::move(fixed)](int) { return fixed; }) {}  // NOLINT: the usual case
  explicit Anchored(std::function<Stream(int frame)> from) : at(std::move(from)) {}
  std::function<Stream(int frame)> at;
};

/// From where `on` holds, without `off`, until `off` holds; gaps of at most `bridging` ticks are
/// closed.
Runs Hold(const Stream& on, const Anchored& off, const Ticks& ticks, Tick bridging);

/// `from .. to [within] [during]`; `within` < 0: no deadline. What has not ended in time is
/// dropped.
Runs FromTo(const Stream& from, const Anchored& to, const Anchored& during, bool or_drop,
            const Ticks& ticks, Tick within = -1);

/// An interval in frames and in ticks. A deadline may lie between two frames: the run ends with the
/// first frame at or after it, the interval with itself.
struct Timed {
  Run run;
  Interval ticks;
  Tick completed = 0;  ///< of a composition: when its last part has ended

  Tick Complete() const { return std::max(completed, ticks.end); }
};
std::vector<Timed> InTicks(const Runs& runs, const Ticks& ticks);
Runs RunsOf(const std::vector<Timed>& timed);

/// `from each from to to within within during during`: for each `to` the first `from` that waits
/// for it, and is not too far back.
Runs FromEachTo(const Stream& from, const Stream& to, const Stream& during, bool or_drop,
                const Ticks& ticks, Tick within);

/// `from .. without .. within [during]`; `within` in ticks, and perhaps not a whole number of them.
std::vector<Timed> FromWithout(const Stream& from, const Anchored& without, const Anchored& during,
                               const Ticks& ticks, double within);

/// `approaching signal receding at most slack [over over] [, slower than speed [or within still
/// over still_over] at most idle]`, one tick being 1 ms. The signal is the place of the hand.
struct Approach {
  std::vector<double> signal;
  double slack = 0;
  double over = 0;
  double still = -1;  ///< negative: nothing is said of it
  double still_over = 0;
  double speed = 0;
  double onset = 0;
  Tick idle = -1;
};
Runs UntilSince(const Stream& until, const Anchored& since, const Ticks& ticks, Tick back,
                const Approach* approach = nullptr);

/// `compose`: `fits` judges one interval of each part.
std::vector<Timed> Compose(const std::vector<std::vector<Timed>>& parts,
                           const std::function<bool(const std::vector<Interval>&)>& fits,
                           bool takes_first = false);
/// `all of`: at most `within` ticks long.
std::vector<Timed> AllOf(const std::vector<std::vector<Timed>>& parts,
                         const std::function<bool(const std::vector<Interval>&)>& fits,
                         Tick within);
/// `repeat .. within`: from the first interval on that has at least so many in so many ticks, all
/// that are in them.
std::vector<Timed> RepeatWithin(std::vector<Timed> intervals, int at_least, Tick within);
/// None of the intervals has a moment between the two.
bool NothingBetween(const std::vector<Timed>& intervals, const Interval& left,
                    const Interval& right);
std::vector<Timed> RestOf(const std::vector<Timed>& whole, const std::vector<Stream>& outside,
                          const Ticks& ticks);

/// `repeat`: the longest series of at least so many intervals with gaps of at most `gap` ticks; of
/// several events, in any order.
std::vector<Timed> Repeat(std::vector<Timed> intervals, int at_least, Tick gap);

/// `one .. per ..`: of the runs of several candidates, one at a time. Who has it keeps it as long
/// as a run of theirs goes on. When it is free, of those who hold at some frame up to `within`
/// ticks after the first, the nearest at their first one gets it; of equals the first in the list.
/// `away[c][frame]`: how far candidate c is, no number if nobody knows; of several, such are left
/// out, and nobody gets it in a frame where none is left.
std::vector<Runs> OnePer(const std::vector<Runs>& candidates,
                         const std::vector<std::vector<double>>& away, const Ticks& ticks,
                         Tick within);

Runs Lasting(const Runs& runs, const Ticks& ticks, Tick lasting);
Runs ConfirmedBy(const Runs& runs, const Runs& by, const Stream& within);

}  // namespace prehend::grammar::reference

// SPDX-License-Identifier: Apache-2.0
// What became of each run of a rule. The engine notes it for explanations, if it is asked to.
// Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <variant>
#include <vector>

#include "grammar/base/ids.h"
#include "grammar/base/span.h"

namespace prehend::grammar {

/// Where a walk back from an end stopped, and why.
struct WalkBack {
  enum class Stop {
    kTooFarBack,   ///< it looks no further back
    kFirstFrame,   ///< the episode begins here
    kPreviousEnd,  ///< the `until` before this one
    kSince,        ///< the condition does not hold at `at`
    kReceding,     ///< at `at` the signal is too far below its largest value
    kIdle,         ///< from `at` on it paused for too long
  };
  FrameNumber begin =
      0;  ///< where the interval begins; the end itself: nowhere; kNever: not known yet
  Stop stop = Stop::kSince;
  FrameNumber at = 0;
};

/// What became of a run, and why.
namespace fate {
struct Interval {
  FrameNumber confirmed = kNever;  ///< the frame of its confirmation, if it needed one
};
struct TooShort {};  ///< `lasting`
struct TooLong {};   ///< `lasting .. to`
struct TooFew {      ///< `repeat .. at least`
  int found = 0;
};
struct Refused {};    ///< `requires` was false at its end
struct Unconfirmed {  ///< `within` ended, or the episode did, before `by` began
  FrameNumber over = 0;
};
struct Dropped {  ///< `during` was false, before the end came
  FrameNumber at = 0;
};
struct TooLate {};      ///< no end `within` the time
struct Came {};         ///< what must not come came
struct Unfinished {};   ///< `or drop`, and the episode ended
struct NothingBack {};  ///< an `until` with no frame before it to begin with
struct WalkedBack {};   ///< an `until` with some; what becomes of them is noted next
}  // namespace fate

using Fate = std::variant<fate::Interval, fate::TooShort, fate::TooLong, fate::TooFew,
                          fate::Refused, fate::Unconfirmed, fate::Dropped, fate::TooLate,
                          fate::Came, fate::Unfinished, fate::NothingBack, fate::WalkedBack>;

/// One run, from where it began to where it ended or was given up.
struct CandidateOutcome {
  Fate fate;
  InstanceId instance;
  Span span;
  Tick decided = 0;
  WalkBack walk = {};  ///< kUntilSince only
  template <typename Which>
  const Which* If() const {
    return std::get_if<Which>(&fate);
  }
  bool IsInterval() const { return If<fate::Interval>() != nullptr; }
};

using CandidateLog = std::vector<CandidateOutcome>;

}  // namespace prehend::grammar

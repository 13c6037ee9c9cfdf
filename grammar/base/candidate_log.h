// SPDX-License-Identifier: Apache-2.0
// What became of each run of a rule. The engine notes it for explanations, if it is asked to.
// Tested by tests/harness/show/explain/explain_test.cc
#pragma once

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

/// One run, from where it began to where it ended or was given up.
struct CandidateOutcome {
  enum class Kind {
    kInterval,  ///< it is an interval; `cause` is the frame of its confirmation, if it needed one
    kTooShort,  ///< `lasting`
    kTooLong,   ///< `lasting .. to`
    kTooFew,    ///< `repeat .. at least`; there were `cause`
    kRefused,   ///< `requires` was false at its end
    kUnconfirmed,  ///< `within` ended at `cause`, or the episode did, before `by` began
    kDropped,      ///< `during` was false at `cause`, which came before the end
    kTooLate,      ///< no end `within` the time
    kCame,         ///< what must not come came
    kUnfinished,   ///< `or drop`, and the episode ended
    kNothingBack,  ///< an `until` with no frame before it to begin with
    kWalkedBack,   ///< an `until` with some; what becomes of them is noted next
  };
  Kind kind = Kind::kInterval;
  InstanceId instance;
  Span span;
  FrameNumber cause = kNever;
  Tick decided = 0;
  WalkBack walk = {};  ///< kUntilSince only
};

using CandidateLog = std::vector<CandidateOutcome>;

}  // namespace prehend::grammar

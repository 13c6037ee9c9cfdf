// SPDX-License-Identifier: Apache-2.0
// Frames by number, and intervals with the frames of their boundaries.
// Tested by tests/grammar/state/history_test.cc
#pragma once

#include <cstdint>
#include <limits>

#include "grammar/base/frame.h"

namespace prehend::grammar {

/// Frames are numbered 0, 1, 2, ... as they arrive.
using FrameNumber = std::int64_t;
inline constexpr FrameNumber kNever = std::numeric_limits<FrameNumber>::max();

/// A frame and its tick.
struct Moment {
  FrameNumber frame = 0;
  Tick tick = 0;
};

/// An interval with the frames of its boundaries.
struct Span {
  Moment begin;
  Moment end;
  bool open_end = false;
  bool judged = false;  ///< of a part: all compositions that were complete with it have been found
  int owner = -1;       ///< of `one .. per`: the entity whose it is
  Moment completed = {};  ///< of a composition: where its last part ends, if that is later

  /// From here on it is known.
  Moment Complete() const {
    return completed.tick > end.tick && completed.frame > 0 ? completed : end;
  }
};

}  // namespace prehend::grammar

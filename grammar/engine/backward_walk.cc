// SPDX-License-Identifier: Apache-2.0
// See grammar/engine/backward_walk.h.
//
// Needs: the frame `end` at which `until` is true; `since`, and with `approaching` a signal and its
// speed, at every frame before it.
// Assumptions: all frames from limits.first on are remembered. A value may be unknown, as it may
// wait for frames to come; then the walk is repeated when more is known.
// Algorithm: frames are visited from `end` backwards, as long as `since` holds. Without
// `approaching`, the interval begins at the earliest of them. With it, the signal must not recede.
// Read backwards, that is: it must not fall below its largest value so far by more than `slack`. If
// it does, the hand had turned there, and the interval begins with the movement that left the
// farthest point. A pause that is too long ends the walk as well, and the interval begins with the
// movement after it. A movement includes its slow start: the frames right before it that are faster
// than `onset`.
// Data: four values of the frames visited so far (Progress).
#include "grammar/engine/backward_walk.h"

#include <algorithm>

namespace prehend::grammar {
namespace {

using Stop = WalkBack::Stop;

class BackwardWalk {
 public:
  BackwardWalk(FrameNumber end, const UntilSinceRule& rule, RuleInstance& instance,
               const WalkLimits& limits, const Evaluator& evaluator, const History& history)
      : end_(end),
        rule_(rule),
        instance_(instance),
        limits_(limits),
        evaluator_(evaluator),
        history_(history),
        so_far_{.begin = end, .turn = end, .last_progress = end} {}

  WalkBack Run() {
    if (rule_.approach) {
      const std::optional<double> at_end = Signal(end_);
      if (!at_end) return kNotKnownYet;
      so_far_.farthest = so_far_.after = *at_end;
    }
    for (FrameNumber frame = end_ - 1; frame >= limits_.first; --frame) {
      const Kleene since = evaluator_.Truth(rule_.since, {instance_, frame, end_});
      if (since == Kleene::kUnknown) return kNotKnownYet;
      if (since == Kleene::kFalse) return {so_far_.begin, Stop::kSince, frame};
      if (!rule_.approach) {
        so_far_.begin = frame;
      } else if (const std::optional<WalkBack> stopped = Approach(frame)) {
        return *stopped;
      }
    }
    return {so_far_.begin, limits_.at_first, limits_.first};
  }

 private:
  static constexpr WalkBack kNotKnownYet{.begin = kNever};

  /// What the frames between the newest one visited and the end have shown.
  struct Progress {
    FrameNumber begin =
        0;                 ///< the earliest frame of movement; if pauses do not count, the earliest
    FrameNumber turn = 0;  ///< where the movement from the farthest point began
    FrameNumber last_progress = 0;  ///< the earliest frame that is no pause
    double farthest = 0;            ///< the signal's largest value
    double after = 0;               ///< the signal one frame later
  };

  // The next frame of an approach; a result if the walk ends there.
  std::optional<WalkBack> Approach(FrameNumber frame) {
    const grammar::Approach& approach = *rule_.approach;
    const std::optional<double> here = Signal(frame);
    if (!here) return kNotKnownYet;
    if (*here < so_far_.farthest - approach.slack)
      return WalkBack{so_far_.turn, Stop::kReceding, frame};
    const std::optional<double> speed = Speed(frame, *here - so_far_.after);
    if (!speed) return kNotKnownYet;
    if (*speed >= approach.speed) {
      so_far_.last_progress = frame;
    } else if (approach.idle_s >= 0 && TicksFrom(frame, so_far_.last_progress) > limits_.idle) {
      return WalkBack{so_far_.begin, Stop::kIdle, so_far_.last_progress};
    }
    const auto moves_into = [&](FrameNumber movement) {
      const bool is_slow_start = movement == frame + 1 && *speed > approach.onset;
      return *speed >= approach.speed || is_slow_start;
    };
    if (*here > so_far_.farthest && moves_into(so_far_.turn)) so_far_.turn = frame;
    if (approach.idle_s < 0 || moves_into(so_far_.begin)) so_far_.begin = frame;
    so_far_.farthest = std::max(so_far_.farthest, *here);
    so_far_.after = *here;
    return std::nullopt;
  }

  std::optional<double> Signal(FrameNumber frame) const {
    return evaluator_.Number(rule_.approach->signal, {instance_, frame, end_});
  }

  // From this frame to the next one, over which the signal falls by `way`.
  std::optional<double> Speed(FrameNumber frame, double way) const {
    const NodeId motion = rule_.approach->motion;
    if (motion != kNone) return evaluator_.Number(motion, {instance_, frame + 1, end_});
    return way / history_.Seconds(TicksFrom(frame, frame + 1));
  }

  Tick TicksFrom(FrameNumber early, FrameNumber late) const {
    return history_.At(late).tick - history_.At(early).tick;
  }

  const FrameNumber end_;
  const UntilSinceRule& rule_;
  RuleInstance& instance_;
  const WalkLimits& limits_;
  const Evaluator& evaluator_;
  const History& history_;
  Progress so_far_;
};

}  // namespace

WalkBack WalkBackFrom(FrameNumber end, const UntilSinceRule& rule, RuleInstance& instance,
                      const WalkLimits& limits, const Evaluator& evaluator,
                      const History& history) {
  return BackwardWalk(end, rule, instance, limits, evaluator, history).Run();
}

}  // namespace prehend::grammar

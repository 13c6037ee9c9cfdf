// SPDX-License-Identifier: Apache-2.0
// Needs: the frame `end` at which `until` is true; `since`, and with `approaching` a signal and its
// speed, at every frame before it.
// Assumptions: all frames from limits.first on are remembered. A value may be unknown, as it may
// wait for frames to come; then the walk is repeated when more is known.
// Algorithm: frames are visited from `end` backwards, as long as `since` holds. Without
// `approaching`, the interval begins at the earliest of them. With it, the signal must not recede.
// Read backwards, that is: it (or its median over a while) must not fall below its largest value so
// far by more than `slack`. If it does, the hand had turned there, and the interval begins with the
// movement that left the farthest point. A pause that is too long ends the walk as well, and the
// interval begins with the movement after it. A movement includes its slow start: the frames right
// before it that are faster than `onset`. If a trembling hand can pause, its movement begins where
// it leaves its place, and the slow start is where it does not slow down.
// Data: a few values of the frames visited so far (Progress), and their medians.
#include "grammar/values/backward_walk.h"

#include <algorithm>
#include <cmath>

namespace prehend::grammar {
namespace {

using Stop = WalkBack::Stop;

class BackwardWalk {
 public:
  BackwardWalk(FrameNumber end, const UntilSinceRule& rule, RuleInstance& instance,
               const WalkLimits& limits, const Evaluator& evaluator, const History& history,
               WalkMemory& memory)
      : end_(end),
        rule_(rule),
        instance_(instance),
        limits_(limits),
        evaluator_(evaluator),
        history_(history),
        so_far_{.begin = end, .turn = end, .top = end, .last_progress = end},
        memory_(memory) {
    memory_.levels.clear();
  }

  WalkBack Run() {
    if (rule_.approach) {
      const std::optional<double> at_end = Signal(end_), level = Level(end_);
      if (!at_end || !level) return kNotKnownYet;
      if (std::isnan(*at_end) || std::isnan(*level)) return {end_, Stop::kSince, end_};
      so_far_.after = *at_end;
      so_far_.farthest = *level;
      if (rule_.approach->over_s > 0) memory_.levels.push_back(*level);
    }
    for (FrameNumber frame = end_ - 1; frame >= limits_.first; --frame) {
      const Kleene since = evaluator_.Truth(rule_.since, {instance_, frame, end_});
      if (since == Kleene::kUnknown) return kNotKnownYet;
      if (since == Kleene::kFalse)
        return {MovementFrom(so_far_.begin, frame + 1), Stop::kSince, frame};
      if (!rule_.approach) {
        so_far_.begin = frame;
      } else if (const std::optional<WalkBack> stopped = Approach(frame)) {
        return *stopped;
      }
    }
    return {MovementFrom(so_far_.begin, limits_.first), limits_.at_first, limits_.first};
  }

 private:
  static constexpr WalkBack kNotKnownYet{.begin = kNever};

  /// What the frames between the newest one visited and the end have shown.
  struct Progress {
    FrameNumber begin =
        0;                 ///< the earliest frame of movement; if pauses do not count, the earliest
    FrameNumber turn = 0;  ///< where the movement from the farthest point began
    FrameNumber top = 0;   ///< the farthest point
    FrameNumber last_progress = 0;  ///< the earliest frame that is no pause
    double farthest = 0;            ///< the largest level
    double after = 0;               ///< the signal one frame later
  };

  // The next frame of an approach; a result if the walk ends there.
  std::optional<WalkBack> Approach(FrameNumber frame) {
    const grammar::Approach& approach = *rule_.approach;
    const std::optional<double> here = Signal(frame), level = Level(frame);
    if (!here || !level) return kNotKnownYet;
    if (std::isnan(*here) || std::isnan(*level))  // not tracked: nothing leads back over it
      return WalkBack{MovementFrom(so_far_.begin, frame + 1), Stop::kSince, frame};
    if (*level < so_far_.farthest - approach.slack)
      return WalkBack{AfterTurn(frame), Stop::kReceding, frame};
    const std::optional<double> speed = Speed(frame, *here - so_far_.after);
    if (!speed) return kNotKnownYet;
    const bool moves = *speed >= approach.speed && !Stays(frame + 1);
    if (moves) {
      so_far_.last_progress = frame;
    } else if (approach.idle_s >= 0 && TicksFrom(frame, so_far_.last_progress) > limits_.idle) {
      return WalkBack{MovementFrom(so_far_.begin, frame), Stop::kIdle, so_far_.last_progress};
    }
    const bool is_slow_start =
        so_far_.begin == frame + 1 && *speed > approach.onset && approach.hand == kNone;
    if (approach.idle_s < 0 || moves || is_slow_start) so_far_.begin = frame;
    if (*level > so_far_.farthest) {
      so_far_.top = frame;
      so_far_.turn = so_far_.begin;
      so_far_.farthest = *level;
    }
    so_far_.after = *here;
    if (approach.over_s > 0) memory_.levels.push_back(*level);
    return std::nullopt;
  }

  // Where it begins, if it receded before, at `frame`.
  FrameNumber AfterTurn(FrameNumber frame) const {
    const grammar::Approach& approach = *rule_.approach;
    if (approach.over_s <= 0) return MovementFrom(so_far_.turn, so_far_.top);
    // Medians round a sharp turn: the slow start is seen in the signal itself.
    FrameNumber begin = end_;
    while (begin > so_far_.top && memory_.levels[static_cast<std::size_t>(end_ - begin)] <
                                      so_far_.farthest - approach.slack)
      --begin;
    while (begin > frame + 1 && FallsInto(begin)) --begin;
    return begin;
  }

  bool FallsInto(FrameNumber frame) const {
    const double way = Signal(frame - 1).value_or(0) - Signal(frame).value_or(0);
    return way > 0 && Speed(frame - 1, way).value_or(0) > rule_.approach->onset;
  }

  // A movement was noticed at `frame`, and none between `earliest` and there. It begins where the
  // hand leaves its place, and before that as long as it speeds up.
  FrameNumber MovementFrom(FrameNumber frame, FrameNumber earliest) const {
    if (!rule_.approach || rule_.approach->hand == kNone || frame == earliest) return frame;
    FrameNumber begin = frame;
    while (begin + 1 < end_ &&
           evaluator_.Apart_m(hand(), frame, begin + 1) <= rule_.approach->still_m)
      ++begin;
    while (begin > earliest && SpeedsUpInto(begin)) --begin;
    return begin;
  }

  bool SpeedsUpInto(FrameNumber frame) const {
    constexpr double kSteady = 1.1;  // a steady speed counts, errors of sampling included
    const double speed = Speed(frame - 1, 0).value_or(0);
    return speed > rule_.approach->onset &&
           (frame == end_ || speed <= kSteady * Speed(frame, 0).value_or(0));
  }

  bool Stays(FrameNumber frame) const {
    const grammar::Approach& approach = *rule_.approach;
    return approach.hand != kNone &&
           evaluator_.StaysWithin(approach.still_m, limits_.still, hand(), frame, end_);
  }

  int hand() const { return instance_.entities[rule_.approach->hand]; }

  // The signal, or its median over the frames around this one, up to the end.
  std::optional<double> Level(FrameNumber frame) const {
    if (rule_.approach->over_s <= 0) return Signal(frame);
    const Tick now = history_.At(frame).tick;
    const FrameNumber last = std::min(history_.LastNotAfter(now + limits_.over), end_);
    std::vector<double>& values = memory_.around;
    values.clear();
    for (FrameNumber i = history_.FirstNotBefore(now - limits_.over); i <= last; ++i) {
      const std::optional<double> value = Signal(i);
      if (!value || std::isnan(*value)) return value;
      values.push_back(*value);
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
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
  WalkMemory& memory_;
};

}  // namespace

WalkBack WalkBackFrom(FrameNumber end, const UntilSinceRule& rule, RuleInstance& instance,
                      const WalkLimits& limits, const Evaluator& evaluator, const History& history,
                      WalkMemory& memory) {
  return BackwardWalk(end, rule, instance, limits, evaluator, history, memory).Run();
}

}  // namespace prehend::grammar

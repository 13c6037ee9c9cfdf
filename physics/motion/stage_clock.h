// SPDX-License-Identifier: Apache-2.0
// When the steps of a stage begin and end. In a plain stage all begin together. In an ordered stage
// an actor has several steps, or a step names another one that it follows or accompanies. Tested by
// tests/physics/motion/stage_clock_test.cc
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "physics/motion/script.h"

namespace prehend::physics {

/// What a step waits for. Steps are counted through: those of hands, then those of persons.
struct StepLinks {
  std::vector<std::size_t> after;   ///< must have ended
  std::optional<std::size_t> with;  ///< must have begun
  bool is_broken = false;           ///< it names a step that the stage does not have
};
std::vector<StepLinks> LinksOf(const ScriptStage& stage);

/// Whether an actor has several steps, or a step names another.
bool IsOrdered(const ScriptStage& stage);

/// The steps whose turn never comes, since they wait for themselves, for each other or for what
/// does not exist.
std::vector<std::size_t> StuckSteps(const ScriptStage& stage);

/// Planned length of a step with its delay, seconds.
double DurationOf(const Step& step);
double DurationOf(const PersonStep& step);
/// Planned length of a stage, seconds: that of its longest chain of steps.
double DurationOf(const ScriptStage& stage);
/// Planned length of a script, seconds: all stages and the settling time. A thing that does not
/// stand when its place step is over prolongs it; a guarded step may shorten it.
double DurationOf(const Script& script);

/// Keeps the time of one stage, in ticks since it began.
class StageClock {
 public:
  /// Of no stage: it is over.
  StageClock() = default;
  StageClock(const ScriptStage& stage, double rate_hz);

  /// Every step ends by itself, not with its stage.
  bool is_ordered() const { return is_ordered_; }

  /// The steps whose turn comes now; their delay begins.
  std::vector<std::size_t> TakeTurns(std::int64_t tick);
  /// Those of them whose delay is over: they begin now.
  std::vector<std::size_t> TakeBegun(std::int64_t tick);

  bool Plays(std::size_t step) const { return steps_[step].phase == Phase::kPlays; }
  std::int64_t BeginOf(std::size_t step) const { return steps_[step].begin_tick; }
  std::int64_t EndOf(std::size_t step) const { return steps_[step].end_tick; }
  /// The step lasts until then.
  void SetEnd(std::size_t step, std::int64_t tick) { steps_[step].end_tick = tick; }
  /// What waits for it may begin.
  void Finish(std::size_t step) { steps_[step].phase = Phase::kEnded; }

  /// The latest end of a step; none while a step still waits for its turn.
  std::optional<std::int64_t> End() const;
  /// Nothing plays, but steps wait.
  bool IsStuck() const;

 private:
  enum class Phase { kWaits, kDelayed, kPlays, kEnded };
  struct StepTime {
    StepLinks links;
    std::int64_t delay_ticks = 0, duration_ticks = 0;  ///< the duration includes the delay
    Phase phase = Phase::kWaits;
    std::int64_t begin_tick = 0, end_tick = 0;
  };
  bool HasItsTurn(const StepTime& step) const;

  std::vector<StepTime> steps_;
  bool is_ordered_ = false;
};

}  // namespace prehend::physics

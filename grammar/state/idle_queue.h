// SPDX-License-Identifier: Apache-2.0
// Instances that rest and are not open, in the order in which they came to rest. Those that have
// rested for longer than the past is remembered, and for kKept_s, are freed; that does not change
// any result. Many are needed again soon: who puts a thing down has lifted it before.
// Tested by tests/grammar/monitor_test.cc
#pragma once

#include <vector>

#include "grammar/state/history.h"
#include "grammar/state/instances.h"

namespace prehend::grammar {

class IdleQueue {
 public:
  IdleQueue(const Program& program, const History& history, RuleInstances& instances)
      : program_(program),
        history_(history),
        instances_(instances),
        kept_ticks_(history.AtLeastTicks(kKept_s)) {}

  void Queue(RuleInstance& instance) {
    if (!instance.idle_queued) {
      const Tick now = history_.At(history_.now()).tick;
      queue_.PushBack() = {instance.resting_since, now + kept_ticks_, instance.index};
    }
    instance.idle_queued = true;
  }

  /// Frees what has rested since before the first remembered frame and is of no use any more.
  void FreeOld();

 private:
  static constexpr double kKept_s = 0.5;

  struct IdleEntry {
    FrameNumber since = 0;
    Tick kept_until = 0;
    InstanceId instance;
  };

  bool IsOld(const IdleEntry& entry) const {
    return entry.since < history_.first() && entry.kept_until <= history_.At(history_.now()).tick;
  }
  void FreeOrQueue(std::vector<InstanceId>& candidates);
  bool CanBeFreed(const RuleInstance& instance) const;
  bool MayOverlap(const RuleInstance& instance) const;
  const Rule& RuleOf(const RuleInstance& instance) const { return program_.rules[instance.rule]; }

  const Program& program_;
  const History& history_;
  RuleInstances& instances_;
  Tick kept_ticks_ = 0;
  RingBuffer<IdleEntry> queue_;
  std::vector<InstanceId> candidates_;  // kept for its memory
};

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// Instances that rest and are not open, in the order in which they came to rest. Those that have
// rested for longer than the past is remembered are freed; that does not change any result.
// Tested by tests/grammar/monitor_test.cc
#pragma once

#include <vector>

#include "grammar/engine/history.h"
#include "grammar/engine/instances.h"

namespace prehend::grammar {

class IdleQueue {
 public:
  IdleQueue(const Program& program, const History& history, RuleInstances& instances)
      : program_(program), history_(history), instances_(instances) {}

  void Queue(RuleInstance& instance) {
    if (!instance.idle_queued) queue_.PushBack() = {instance.resting_since, instance.index};
    instance.idle_queued = true;
  }

  /// Frees what has rested since before the first remembered frame and is of no use any more.
  void FreeOld();

 private:
  struct IdleEntry {
    FrameNumber since = 0;
    InstanceId instance;
  };

  void FreeOrQueue(std::vector<InstanceId>& candidates);
  bool CanBeFreed(const RuleInstance& instance) const;
  bool MayOverlap(const RuleInstance& instance) const;
  const Rule& RuleOf(const RuleInstance& instance) const { return program_.rules[instance.rule]; }

  const Program& program_;
  const History& history_;
  RuleInstances& instances_;
  RingBuffer<IdleEntry> queue_;
  std::vector<InstanceId> candidates_;  // kept for its memory
};

}  // namespace prehend::grammar

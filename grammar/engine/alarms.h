// SPDX-License-Identifier: Apache-2.0
// Instances to wake when a tick comes: the end of a gap, the shortest duration, a deadline. An
// alarm is never cancelled, so it may wake an instance for nothing. Tested by
// tests/grammar/monitor_test.cc
#pragma once

#include <algorithm>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/program/program.h"

namespace prehend::grammar {

class Alarms {
 public:
  void Set(Tick tick, InstanceId instance) {
    heap_.push_back({tick, instance});
    std::ranges::push_heap(heap_, Later);
  }

  bool AnyDue(Tick now) const { return !heap_.empty() && heap_.front().tick <= now; }

  /// Calls wake(instance) for each alarm up to `now` and drops it.
  template <typename Wake>
  void Sound(Tick now, const Wake& wake) {
    while (AnyDue(now)) {
      wake(heap_.front().instance);
      std::ranges::pop_heap(heap_, Later);
      heap_.pop_back();
    }
  }

 private:
  struct Alarm {
    Tick tick = 0;
    InstanceId instance;
  };
  static bool Later(const Alarm& a, const Alarm& b) { return a.tick > b.tick; }

  std::vector<Alarm> heap_;  // the next one first
};

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// How far each of several processes has come: counters in memory that a parent shares with the
// children that it forks. They outlive a child that is killed. Tested by
// tests/harness/base/process/worker_pool_test.cc
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace prehend {

class ProgressCounters {
 public:
  using Tick = std::atomic<std::int64_t>;
  static constexpr std::int64_t kNone = -1;  ///< the value of each counter at first

  /// Throws std::bad_alloc if the system has no memory to share.
  explicit ProgressCounters(std::size_t count);
  ~ProgressCounters();
  ProgressCounters(const ProgressCounters&) = delete;
  ProgressCounters& operator=(const ProgressCounters&) = delete;

  Tick& operator[](std::size_t i) { return ticks_[i]; }

 private:
  std::size_t count_;
  Tick* ticks_;
};

}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// Runs each job in a process of its own, several at a time. A crash, a hang or a memory blow-up is
// the result of that job; the other jobs are not affected. The caller must not have threads. Values
// on their way from a worker to its parent. A type that goes this way has a to_json and a from_json
// with all its fields. How far each of several processes has come: counters in memory that a parent
// shares with the children that it forks. They outlive a child that is killed. Tested by
// tests/harness/base/process/worker_pool_test.cc and tests/harness/base/process/wire_test.cc
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/base/process/child_process.h"

namespace prehend {

inline constexpr std::uint64_t kMegabyte = 1'000'000;

struct WorkerLimits {
  int jobs = 1;                          ///< processes at a time
  double time_limit_s = 60;              ///< of wall time, for each job
  std::uint64_t memory_limit_bytes = 0;  ///< of private memory (RLIMIT_DATA); 0: none
};

struct WorkerResult {
  bool finished = false;  ///< false: crashed, killed, out of time or memory
  std::string output;     ///< what the job returned; empty unless finished
  /// Empty when finished, else "no end after 60 s", "it needs more memory than 1000 MB",
  /// "crashed (segmentation fault, signal 11) at 998 MB of memory, limit 1000 MB", ..
  std::string reason;
  std::string stderr_tail;  ///< of a job that failed, unless memory ran out
  double seconds = 0, cpu_s = 0;
  std::int64_t peak_memory_kib = 0;
};

/// Runs in the child. What it returns is sent to the parent.
using WorkerJob = std::function<std::string()>;

/// The results, in the order of the jobs, which is also the order in which they start. The parent
/// calls `done` for each job as it ends. When `interrupt` comes, the jobs that run are killed, no
/// further one starts, and `done` is not called for either. `meanwhile` is called in the parent,
/// some times a second while it waits.
///
/// A job ends as out of memory when `new` fails, wherever that is. When a library in C is refused
/// memory, the job ends as that library ends it (a signal, an exit status), and the reason names
/// the peak and the limit.
std::vector<WorkerResult> RunInWorkers(
    const std::vector<WorkerJob>& jobs, const WorkerLimits& limits,
    const std::function<void(std::size_t job, const WorkerResult&)>& done = {},
    Interrupt* interrupt = nullptr, const std::function<void()>& meanwhile = {});

/// How a process ended that RunWithinLimits() started.
struct LimitedEnd {
  int status = 0;      ///< what the job returned
  std::string reason;  ///< "" if it did, else why not, as in WorkerResult
};

/// Runs one job in a process of its own that writes to this one's standard output and error. What
/// it throws is thrown again, as std::runtime_error. `time_limit_s` 0: none; `jobs` does not
/// matter. It dies with this process. When `interrupt` comes, the job is killed.
LimitedEnd RunWithinLimits(const std::function<int()>& job, const WorkerLimits& limits,
                           Interrupt* interrupt = nullptr);

/// As CBOR, since JSON has no infinite numbers and refuses bytes that are no UTF-8.
template <typename T>
std::string ToWire(const T& value) {
  std::string bytes;
  nlohmann::json::to_cbor(value, bytes);
  return bytes;
}

/// Throws nlohmann::json::exception if the bytes are not from ToWire() of that type.
template <typename T>
T FromWire(const std::string& bytes) {
  nlohmann::json value = nlohmann::json::from_cbor(bytes);
  if constexpr (std::is_same_v<T, nlohmann::json>)
    return value;
  else
    return value.get<T>();
}

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

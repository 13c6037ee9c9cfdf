// SPDX-License-Identifier: Apache-2.0
// Runs each job in a process of its own, several at a time. A crash, a hang or a memory blow-up is
// the result of that job; the other jobs are not affected. The caller must not have threads. Tested
// by tests/harness/base/process/worker_pool_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/base/process/interrupt.h"

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
  double seconds = 0;
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
/// matter. It dies with this process.
LimitedEnd RunWithinLimits(const std::function<int()>& job, const WorkerLimits& limits);

}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// Runs jobs in processes of their own, several at a time: a crash, a hang or a memory blow-up of
// one is its result and leaves the others alone. Needs a caller without threads. Tested by
// tests/harness/worker_pool_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace prehend::harness {

inline constexpr std::uint64_t kMegabyte = 1'000'000;

struct WorkerLimits {
  int jobs = 1;                          ///< processes at a time
  double time_limit_s = 60;              ///< of wall time, for each job
  std::uint64_t memory_limit_bytes = 0;  ///< of private memory (RLIMIT_DATA); 0: none
};

struct WorkerResult {
  bool finished = false;    ///< false: crashed, killed, out of time or memory
  std::string output;       ///< what the job returned; empty unless finished
  std::string reason;       ///< "crashed (segmentation fault, signal 11)", "no end after 60 s", "it
                            ///< needs more memory than 1000 MB"; empty when finished
  std::string stderr_tail;  ///< the end of what a job that failed wrote to standard error; empty
                            ///< if memory ran out
  double seconds = 0;
  std::int64_t peak_memory_kib = 0;
};

/// Runs in the child; what it returns travels to the parent.
using WorkerJob = std::function<std::string()>;

/// Results in the order of the jobs, which also start in this order. `done` is called in the parent
/// with each result as it comes.
std::vector<WorkerResult> RunInWorkers(
    const std::vector<WorkerJob>& jobs, const WorkerLimits& limits,
    const std::function<void(std::size_t job, const WorkerResult&)>& done = {});

}  // namespace prehend::harness

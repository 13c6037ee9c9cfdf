// SPDX-License-Identifier: Apache-2.0
// One job misbehaves in every way there is; the others don't notice.
#include "harness/base/process/worker_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <vector>

namespace prehend {
namespace {

std::string Good() { return "good"; }

TEST(WorkerPool, ResultsComeInTheOrderOfTheJobs) {
  std::vector<WorkerJob> jobs;
  for (int i = 0; i < 20; ++i) jobs.push_back([i] { return std::to_string(i); });
  const auto results = RunInWorkers(jobs, {.jobs = 3});
  ASSERT_EQ(results.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(results[i].output, std::to_string(i));
}

TEST(WorkerPool, LargeOutputsArrive) {
  const std::string large(5'000'000, 'x');
  const auto results = RunInWorkers({[&] { return large; }, Good}, {.jobs = 2});
  EXPECT_EQ(results[0].output, large);
}

TEST(WorkerPool, WhatAJobChangesStaysInItsProcess) {
  int counter = 0;
  RunInWorkers({[&] { return std::to_string(++counter); }}, {});
  EXPECT_EQ(counter, 0);
}

TEST(WorkerPool, ProcessorTimeIsOfTheJobAlone) {
  const auto sleep = [] {
    usleep(200'000);
    return Good();
  };
  const auto work = [] {
    while (clock() < CLOCKS_PER_SEC / 5) {
    }
    return Good();
  };
  const auto results = RunInWorkers({sleep, work}, {.jobs = 2, .time_limit_s = 60});
  EXPECT_GE(results[0].seconds, 0.2);
  EXPECT_LT(results[0].cpu_s, 0.1);
  EXPECT_GE(results[1].cpu_s, 0.2);
  EXPECT_LT(results[1].cpu_s, results[1].seconds + 0.02);
}

TEST(WorkerPool, TicksOutliveTheWorker) {
  ProgressCounters ticks(2);
  const auto job = [&](std::size_t i) {
    return [&ticks, i] {
      ticks[i] = 7;
      if (i == 1) raise(SIGKILL);
      return Good();
    };
  };
  RunInWorkers({job(0), job(1)}, {.jobs = 2});
  EXPECT_EQ(ticks[0], 7);
  EXPECT_EQ(ticks[1], 7);
  EXPECT_EQ(ProgressCounters(1)[0], ProgressCounters::kNone);
}

struct Misbehaviour {
  const char* name;
  WorkerJob job;
  const char* reason;
};

class WorkerPoolMisbehaviour : public testing::TestWithParam<Misbehaviour> {};

TEST_P(WorkerPoolMisbehaviour, IsAResult) {
  std::vector<std::size_t> told;
  const auto results = RunInWorkers(
      {Good, GetParam().job, Good}, {.jobs = 2, .time_limit_s = 0.5, .memory_limit_bytes = 0},
      [&](std::size_t job, const WorkerResult&) { told.push_back(job); });
  EXPECT_EQ(told.size(), 3u);
  EXPECT_EQ(results[0].output, "good");
  EXPECT_EQ(results[2].output, "good");
  EXPECT_FALSE(results[1].finished);
  EXPECT_EQ(results[1].output, "");
  EXPECT_EQ(results[1].reason, GetParam().reason);
}

TEST(WorkerPool, WhatAJobSaysBeforeItCrashesIsKept) {
  const WorkerJob talks = [] {
    std::fputs("the sky is falling\n", stderr);
    std::abort();
    return Good();
  };
  const auto results = RunInWorkers({talks}, {});
  EXPECT_EQ(results[0].reason, "aborted (signal 6)");
  EXPECT_EQ(results[0].stderr_tail, "the sky is falling\n");
}

std::string NameOf(const testing::TestParamInfo<Misbehaviour>& row) { return row.param.name; }

TEST(WithinLimits, AJobReturnsOrSaysWhyNot) {
  const WorkerLimits limits{.jobs = 1, .time_limit_s = 0.2};
  EXPECT_EQ(RunWithinLimits([] { return 5; }, limits).status, 5);
  EXPECT_EQ(RunWithinLimits(
                []() -> int {
                  for (;;) pause();
                },
                limits)
                .reason,
            "no end after 0.2 s");
  EXPECT_EQ(RunWithinLimits([]() -> int { _exit(9); }, {.time_limit_s = 0}).status, 9);
  EXPECT_EQ(RunWithinLimits([]() -> int { return raise(SIGFPE); }, {.time_limit_s = 0}).reason,
            "crashed (arithmetic error, signal 8)");
  EXPECT_THROW(RunWithinLimits([]() -> int { throw std::runtime_error("no"); }, limits),
               std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(
    Table, WorkerPoolMisbehaviour,
    testing::Values(
        Misbehaviour{"killed", [] { return raise(SIGKILL), Good(); },
                     "was killed (signal 9: by a user, or by the system because memory ran out)"},
        Misbehaviour{"recurses", [] { return raise(SIGSEGV), Good(); },
                     "crashed (segmentation fault, signal 11)"},
        Misbehaviour{"has_another_signal", [] { return raise(SIGUSR1), Good(); },
                     "ended by signal 10 (User defined signal 1)"},
        Misbehaviour{"hangs", [] { return pause(), Good(); }, "no end after 0.5 s"},
        Misbehaviour{"exits", []() -> std::string { _exit(9); }, "exit status 9"},
        Misbehaviour{"throws", []() -> std::string { throw std::runtime_error("no"); },
                     "exception: no"}),
    NameOf);

// As any program in front of "| head".
TEST(WorkerPool, WhatNobodyReadsAnyMoreEndsQuietly) {
  EXPECT_EXIT(RunWithinLimits([]() -> int { return raise(SIGPIPE); }, {.time_limit_s = 0}),
              testing::KilledBySignal(SIGPIPE), "^$");
}

#ifndef __SANITIZE_ADDRESS__  // its shadow memory alone is above any limit
WorkerResult RunWithin(std::uint64_t limit_mb, const WorkerJob& job) {
  const WorkerLimits limits{
      .jobs = 1, .time_limit_s = 300, .memory_limit_bytes = limit_mb * kMegabyte};
  return RunInWorkers({job}, limits).front();
}

TEST(WorkerPool, MemoryHasALimit) {
  const WorkerJob greedy = [] { return std::string(1'000'000'000, 'x'); };
  const auto results = RunInWorkers(
      {greedy, Good}, {.jobs = 1, .time_limit_s = 300, .memory_limit_bytes = 500'000'000});
  EXPECT_EQ(results[0].reason, "it needs more memory than 500 MB");
  EXPECT_EQ(results[0].stderr_tail, "");
  EXPECT_TRUE(results[1].finished);
}

TEST(WorkerPool, TheLimitHoldsWhereNoExceptionMayPass) {
  const auto must_not_throw = []() noexcept { return std::string(1'000'000'000, 'x'); };
  EXPECT_EQ(RunWithin(500, must_not_throw).reason, "it needs more memory than 500 MB");
}

/// Takes memory as a library in C does, until there is none. Uses it, so that it counts.
void* TakeAllMemory() {
  constexpr std::size_t kPiece_bytes = 1'000'000;
  for (;;) {
    void* const piece = std::malloc(kPiece_bytes);
    if (piece == nullptr) return piece;
    std::memset(piece, 1, kPiece_bytes);
  }
}

TEST(WorkerPool, ALibraryThatIsRefusedMemoryEndsNearTheLimit) {
  const WorkerJob does_not_look = [] {
    *static_cast<volatile char*>(TakeAllMemory()) = 1;
    return Good();
  };
  const WorkerJob aborts = [] {
    if (TakeAllMemory() == nullptr) std::abort();
    return Good();
  };
  const WorkerJob exits = [] {
    if (TakeAllMemory() == nullptr) _exit(9);
    return Good();
  };
  const auto reason_is = [](const WorkerJob& job, const std::string& end) {
    const WorkerResult result = RunWithin(200, job);
    const std::int64_t peak_mb = result.peak_memory_kib * 1024 / 1'000'000;
    EXPECT_GT(peak_mb, 150);
    EXPECT_LT(peak_mb, 300);
    EXPECT_EQ(result.reason,
              end + " at " + std::to_string(peak_mb) + " MB of memory, limit 200 MB");
  };
  reason_is(does_not_look, "crashed (segmentation fault, signal 11)");
  reason_is(aborts, "aborted (signal 6)");
  reason_is(exits, "exit status 9");
}

TEST(WorkerPool, WhatHasTooLittleMemoryToStartIsTold) {
  const std::vector<char> what_this_process_has_already(50'000'000, 'x');
  ASSERT_EQ(what_this_process_has_already.back(), 'x');
  const std::string reason = RunWithin(1, Good).reason;
  EXPECT_TRUE(reason.starts_with("1 MB of memory are too little for it to start, which takes "))
      << reason;
}
#else
TEST(WorkerPool, MemoryHasALimit) { GTEST_SKIP() << "no limit under the address sanitizer"; }
#endif

}  // namespace
}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// One job misbehaves in every way there is; the others don't notice.
#include "harness/worker_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "harness/shared_ticks.h"

namespace prehend::harness {
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

TEST(WorkerPool, TicksOutliveTheWorker) {
  SharedTicks ticks(2);
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
  EXPECT_EQ(SharedTicks(1)[0], SharedTicks::kNone);
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

INSTANTIATE_TEST_SUITE_P(
    Table, WorkerPoolMisbehaviour,
    testing::Values(
        Misbehaviour{"killed", [] { return raise(SIGKILL), Good(); },
                     "was killed (signal 9), possibly because the system ran out of memory"},
        Misbehaviour{"recurses", [] { return raise(SIGSEGV), Good(); },
                     "crashed (segmentation fault, signal 11)"},
        Misbehaviour{"has_another_signal", [] { return raise(SIGUSR1), Good(); },
                     "ended by signal 10 (User defined signal 1)"},
        Misbehaviour{"hangs", [] { return pause(), Good(); }, "no end after 0.5 s"},
        Misbehaviour{"exits", []() -> std::string { _exit(9); }, "exit status 9"},
        Misbehaviour{"throws", []() -> std::string { throw std::runtime_error("no"); },
                     "exception: no"}),
    NameOf);

#ifndef __SANITIZE_ADDRESS__  // its shadow memory alone is above any limit
TEST(WorkerPool, MemoryHasALimit) {
  const WorkerJob greedy = [] { return std::string(1'000'000'000, 'x'); };
  const auto results = RunInWorkers(
      {greedy, Good}, {.jobs = 1, .time_limit_s = 10, .memory_limit_bytes = 500'000'000});
  EXPECT_EQ(results[0].reason, "it needs more memory than 500 MB");
  EXPECT_TRUE(results[1].finished);
}

std::string EndOf(const WorkerJob& job, std::uint64_t limit_mb) {
  const WorkerLimits limits{
      .jobs = 1, .time_limit_s = 10, .memory_limit_bytes = limit_mb * kMegabyte};
  const WorkerResult result = RunInWorkers({job}, limits).front();
  EXPECT_EQ(result.stderr_tail, "");
  return result.finished ? "finished" : result.reason;
}

// Libraries in C do not look, or abort; C++ cannot throw out of what must not throw.
TEST(WorkerPool, WhoeverIsRefusedMemoryTheReasonIsTheSame) {
  const char* const reason = "it needs more memory than 500 MB";
  constexpr std::size_t kTooMuch = 1'000'000'000;
  const auto use = [](void* memory) {
    static_cast<volatile char*>(memory)[0] = 1;  // a crash for who did not look
    std::free(memory);
    return Good();
  };
  EXPECT_EQ(EndOf([&] { return use(std::malloc(kTooMuch)); }, 500), reason);
  EXPECT_EQ(EndOf([&] { return use(std::calloc(kTooMuch, 1)); }, 500), reason);
  EXPECT_EQ(EndOf([&] { return use(std::realloc(std::malloc(1), kTooMuch)); }, 500), reason);
  EXPECT_EQ(EndOf([&] { return use(std::aligned_alloc(64, kTooMuch - kTooMuch % 64)); }, 500),
            reason);
  EXPECT_EQ(EndOf(
                [&] {
                  void* memory = nullptr;
                  return posix_memalign(&memory, 64, kTooMuch) == 0 ? use(memory) : Good();
                },
                500),
            reason);
  const auto must_not_throw = []() noexcept { return std::string(kTooMuch, 'x'); };
  EXPECT_EQ(EndOf(must_not_throw, 500), reason);
  EXPECT_EQ(EndOf([&] { return use(std::malloc(1000)); }, 500), "finished");
}

TEST(WorkerPool, WhatHasTooLittleMemoryToStartIsTold) {
  const std::vector<char> what_this_process_has_already(50'000'000, 'x');
  ASSERT_EQ(what_this_process_has_already.back(), 'x');
  const std::string reason = EndOf(Good, 1);
  EXPECT_TRUE(reason.starts_with("1 MB of memory are too little for it to start, which takes "))
      << reason;
}
#else
TEST(WorkerPool, MemoryHasALimit) { GTEST_SKIP() << "no limit under the address sanitizer"; }
#endif

}  // namespace
}  // namespace prehend::harness

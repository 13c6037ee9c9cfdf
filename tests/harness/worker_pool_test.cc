// SPDX-License-Identifier: Apache-2.0
// One job misbehaves in every way there is; the others don't notice.
#include "harness/worker_pool.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

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

std::string NameOf(const testing::TestParamInfo<Misbehaviour>& row) { return row.param.name; }

INSTANTIATE_TEST_SUITE_P(
    Table, WorkerPoolMisbehaviour,
    testing::Values(Misbehaviour{"killed", [] { return raise(SIGKILL), Good(); },
                                 "signal 9 (Killed)"},
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
  EXPECT_EQ(results[0].reason, "more memory than 500 MB");
  EXPECT_TRUE(results[1].finished);
}
#endif

}  // namespace
}  // namespace prehend::harness

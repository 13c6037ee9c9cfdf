// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

#include "harness/base/process/child_process.h"

namespace prehend {
namespace {

TEST(RunTool, TextGoesThroughAnotherProgram) {
  const std::string much(3'000'000, 'x');  // more than the system keeps between two programs
  const ToolResult copied = RunTool({"cat"}, much);
  EXPECT_TRUE(copied.Succeeded()) << copied.problem;
  EXPECT_EQ(copied.out, much);
  const ToolResult failed = RunTool({"sh", "-c", "echo no >&2; exit 7"}, "unread");
  EXPECT_EQ(failed.exit_code, 7);
  EXPECT_EQ(failed.err, "no\n");
  EXPECT_FALSE(failed.Succeeded());
  EXPECT_EQ(RunTool({"echo", "$HOME; rm *"}, "").out, "$HOME; rm *\n") << "no shell";
}

TEST(RunTool, WhatDoesNotEndByItselfSaysWhy) {
  EXPECT_EQ(RunTool({"no-such-tool"}, "").problem, "'no-such-tool' is not installed");
  EXPECT_EQ(RunTool({"sleep", "60"}, "", {.time_s = 0.1}).problem, "took more than 0.1 s");
  // What takes long to begin has its time from its first line on.
  EXPECT_EQ(
      RunTool({"sh", "-c", "echo on; sleep 60"}, "", {.time_s = 60, .answering_s = 0.1}).problem,
      "took more than 0.1 s");
  EXPECT_EQ(RunTool({"sh", "-c", "sleep 60"}, "", {.time_s = 0.1, .answering_s = 60}).problem,
            "took more than 0.1 s");
  EXPECT_EQ(RunTool({"yes"}, "", {.output_bytes = 1000}).problem, "printed more than 1000 bytes");
  EXPECT_EQ(RunTool({"sh", "-c", "kill -9 $$"}, "").problem, "was ended by signal 9");
  EXPECT_TRUE(RunTool({"true"}, std::string(1'000'000, 'x')).Succeeded())
      << "a program that reads nothing does no harm";
}

TEST(RunTool, NoProgramOutlivesWhoAskedForIt) {
  for (int i = 0; i < 20; ++i) {
    int said[2];
    ASSERT_EQ(pipe(said), 0);
    const pid_t parent = fork();
    if (parent == 0) {
      const std::string number = "echo $$ >&" + std::to_string(said[1]) + "; exec sleep 60";
      RunTool({"sh", "-c", number}, "");
      _exit(0);
    }
    close(said[1]);
    // Killed after the program has said its number, or at some moment before.
    char text[32] = {};
    if (i % 2 == 0) {
      ASSERT_GT(read(said[0], text, sizeof text - 1), 0);
    } else {
      usleep(static_cast<useconds_t>(300 * i));
    }
    kill(parent, SIGKILL);
    waitpid(parent, nullptr, 0);
    if (i % 2 != 0 && read(said[0], text, sizeof text - 1) <= 0) text[0] = '\0';
    // Nobody has the other end any more: this is the end, and no timeout.
    char more;
    const auto begin = std::chrono::steady_clock::now();
    while (read(said[0], &more, 1) > 0) {
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20)) << text;
    close(said[0]);
  }
}

}  // namespace
}  // namespace prehend

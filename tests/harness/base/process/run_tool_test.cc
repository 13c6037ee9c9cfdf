// SPDX-License-Identifier: Apache-2.0
#include "harness/base/process/run_tool.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace prehend

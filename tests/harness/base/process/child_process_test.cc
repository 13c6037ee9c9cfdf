// SPDX-License-Identifier: Apache-2.0
#include "harness/base/process/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>

namespace prehend {
namespace {

using How = ChildProcess::How;

/// What a shell said, up to its end.
std::string Said(ChildProcess& child) {
  for (int i = 0; i < 1000 && !child.has_said_all(); ++i) child.Exchange(0.05);
  EXPECT_TRUE(child.has_said_all());
  EXPECT_TRUE(child.HasEnded(5));
  return child.out;
}

bool Runs(const std::string& id) {
  std::ifstream status("/proc/" + id + "/stat");
  std::string number, name, state;
  return status >> number >> name >> state && state != "Z" && state != "X";
}

bool EndsSoon(const std::string& id) {
  for (int i = 0; i < 200 && Runs(id); ++i) usleep(10'000);
  return !Runs(id);
}

TEST(ChildProcess, TalksLineByLine) {
  for (const bool is_watched : {false, true}) {
    ChildProcess child;
    ASSERT_EQ(child.Start({"sh", "-c", "read a; echo got $a; read b; echo $b $NAME; echo e >&2"},
                          {.environment = {"NAME=x y"}, .is_watched = is_watched}),
              "");
    child.Send("one\n");
    for (int i = 0; i < 100 && child.out.empty(); ++i) child.Exchange(0.05);
    EXPECT_EQ(child.out, "got one\n");
    child.Send("two\n");
    child.CloseInput();
    EXPECT_EQ(Said(child), "got one\ntwo x y\n");
    EXPECT_EQ(child.err, "e\n");
    EXPECT_EQ(child.end().exit_code, 0);
  }
}

TEST(ChildProcess, SaysHowItEnded) {
  for (const bool is_watched : {false, true}) {
    ChildProcess coded, signalled, missing;
    ASSERT_EQ(coded.Start({"sh", "-c", "exit 7"}, {.is_watched = is_watched}), "");
    Said(coded);
    EXPECT_EQ(coded.end().exit_code, 7);
    ASSERT_EQ(signalled.Start({"sh", "-c", "kill -9 $$"}, {.is_watched = is_watched}), "");
    Said(signalled);
    EXPECT_EQ(signalled.end().signal, 9);
    EXPECT_EQ(missing.Start({"no-such-program"}, {.is_watched = is_watched}),
              "'no-such-program' is not installed");
  }
}

TEST(ChildProcess, SaysWhetherAllWasRead) {
  for (const char* program : {"read a; read b", "read a", "exit 0"}) {
    for (const std::size_t size : {std::size_t{10}, std::size_t{1'000'000}}) {
      ChildProcess child;
      ASSERT_EQ(child.Start({"sh", "-c", program}, {.is_watched = true}), "");
      child.Send("one\n" + std::string(size, 'x') + "\n");
      child.CloseInput();
      Said(child);
      EXPECT_EQ(child.HasReadAll(), program == std::string("read a; read b")) << program << size;
    }
  }
}

TEST(ChildProcess, OfAWatchedOneNothingIsLeft) {
  // In its group, in a session of its own, and in the background of one that has ended.
  const std::string forks =
      "sleep 300 & echo $!; setsid sleep 300 & echo $!; (sh -c 'sleep 300 & echo $!' & wait); ";
  for (const char* then : {"exit 0", "sleep 300"}) {
    ChildProcess child;
    ASSERT_EQ(child.Start({"sh", "-c", forks + then}, {.is_watched = true}), "");
    for (int i = 0; i < 100 && std::count(child.out.begin(), child.out.end(), '\n') < 3; ++i)
      child.Exchange(0.05);
    if (then == std::string("exit 0"))
      Said(child);
    else
      child.Kill();
    std::istringstream ids(child.out);
    int count = 0;
    for (std::string id; ids >> id; ++count) EXPECT_TRUE(EndsSoon(id)) << id << " after " << then;
    EXPECT_EQ(count, 3);
  }
}

TEST(ChildProcess, AWatchedOneEndsWithItsParent) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    ChildProcess child;
    if (!child.Start({"sh", "-c", "echo $$; sleep 300"}, {.is_watched = true}).empty()) _exit(1);
    while (child.out.empty()) child.Exchange(0.05);
    (void)!write(ends[1], child.out.data(), child.out.size());
    raise(SIGKILL);
  }
  char id[32] = {};
  ASSERT_GT(read(ends[0], id, sizeof id - 1), 0);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(EndsSoon(std::to_string(std::atoi(id)))) << id;
  close(ends[0]);
  close(ends[1]);
}

}  // namespace
}  // namespace prehend

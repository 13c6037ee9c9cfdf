// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/task_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/text_file.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

TEST(TaskFilesOfARun, ComeBackWhereTheProjectIsGone) {
  const fs::path folder =
      fs::temp_directory_path() / ("prehend_task_files_" + std::to_string(getpid()));
  fs::remove_all(folder);
  const std::string root = (folder / "home").string(), outside = (folder / "my.grammar").string();
  ASSERT_EQ(WriteTextFile(root + "/scenarios/reach/a.yaml", "name: a\n"), "");
  ASSERT_EQ(WriteTextFile(outside, "grammar my\n"), "");
  fs::create_directories(root + "/grammar/library");  // has what it needs
  const TaskFiles task = PackTask(
      {.scenario_file = root + "/scenarios/reach/a.yaml", .grammar = outside, .settings = {"a=1"}},
      {root + "/scenarios/reach/a.yaml", outside, root + "/no/such/file"}, root);
  EXPECT_EQ(task.run.scenario_file, "scenarios/reach/a.yaml");
  ASSERT_EQ(task.files.size(), 2u);
  fs::remove_all(folder);

  std::string unpacked;
  {
    UnpackedTasks tasks;
    ASSERT_EQ(tasks.Unpack(task), "");
    const RunRequest run = tasks.RequestOf(task);
    unpacked = run.scenario_file;
    EXPECT_EQ(*ReadTextFile(run.scenario_file), "name: a\n");
    EXPECT_EQ(*ReadTextFile(run.grammar), "grammar my\n");
    EXPECT_EQ(run.settings, std::vector<std::string>{"a=1"});
    EXPECT_EQ(tasks.Original(run.scenario_file), "scenarios/reach/a.yaml");
    EXPECT_EQ(tasks.Original(run.grammar), outside);
  }
  EXPECT_FALSE(fs::exists(unpacked));
}

TEST(TaskFilesOfARun, HaveAFolderFromTheFirstTaskOn) {
  UnpackedTasks tasks;
  EXPECT_EQ(tasks.root(), "") << "most episodes that are checked are played, and unpack nothing";
  TaskFiles task;
  task.files = {{"scenarios/a/a.yaml", "scenario: a"}};
  ASSERT_EQ(tasks.Unpack(task), "");
  const std::string root = tasks.root();
  EXPECT_TRUE(fs::is_directory(root + "/grammar/library"));
  ASSERT_EQ(tasks.Unpack(task), "");
  EXPECT_EQ(tasks.root(), root);
}

TEST(TaskFilesOfARun, StayBelowTheFolderOfTheirTask) {
  UnpackedTasks tasks;
  const std::string victim =
      (fs::temp_directory_path() / ("prehend_victim_" + std::to_string(getpid()))).string();
  TaskFiles task;
  task.files["../../../../../../../../../.." + victim] = "x";
  ASSERT_EQ(tasks.Unpack(task), "");
  EXPECT_FALSE(fs::exists(victim));
}

TEST(TaskFilesOfARun, SayThatWhatWasReadOfThemIsOld) {
  UnpackedTasks tasks;
  TaskFiles task;
  task.files = {{"scenarios/a/own.grammar", "grammar own"}, {"scenarios/a/a.yaml", "scenario: a"}};
  ASSERT_EQ(tasks.Unpack(task), "");
  const std::size_t before = tasks.writes();
  ASSERT_EQ(tasks.Unpack(task), "");
  EXPECT_EQ(tasks.writes(), before) << "the same files";
  task.files["scenarios/a/a.yaml"] = "scenario: b";
  ASSERT_EQ(tasks.Unpack(task), "");
  EXPECT_EQ(tasks.writes(), before) << "a scenario is read each time";
  task.files["scenarios/a/own.grammar"] = "grammar other";
  ASSERT_EQ(tasks.Unpack(task), "");
  EXPECT_GT(tasks.writes(), before) << "a grammar beside a scenario is kept when it is compiled";
}

TEST(TaskFilesOfARun, AreOneTaskOnlyIfEverythingIsEqual) {
  TaskFiles a;
  a.run.scenario_file = "s.yaml";
  a.files["s.yaml"] = "name: s\n";
  TaskFiles b = a, c = a;
  b.run.settings = {"x=1"};
  c.files["s.yaml"] = "name: t\n";
  EXPECT_NE(a.Identity(), b.Identity());
  EXPECT_NE(a.Identity(), c.Identity());
}

}  // namespace
}  // namespace prehend::episode

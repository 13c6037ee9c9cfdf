// SPDX-License-Identifier: Apache-2.0
// What is refused before any command runs: a stack that is too small, folders that cannot be read,
// outputs that are inputs. And what a pipe or the word "--" does.
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <map>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> FilesBelow(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().string().find("/build/") == std::string::npos)
      files[entry.path().string()] = ReadFile(entry.path());
  return files;
}

class Preconditions : public SmallProject {
 protected:
  /// The program after a command of the shell in the same process, like `ulimit -n 4`.
  Said DoAfter(const std::string& before, const std::string& arguments) const {
    const std::string out = (root_ / "out").string(), err = (root_ / "err").string();
    const int status = std::system(("bash -c '" + before + " && PREHEND_HOME=" + root_.string() +
                                    " exec " PREHEND_BINARY_DIR "/prehend " + arguments + "' >" +
                                    out + " 2>" + err)
                                       .c_str());
    return {WEXITSTATUS(status), ReadFile(out), ReadFile(err)};
  }
};

TEST_F(Preconditions, ASmallStackIsRefused) {
  for (const char* command : {"list", "check --no-pictures", "score", "run carton_rests",
                              "accept carton_rests --reason x"}) {
    const Said said = DoAfter("ulimit -s 64", command);
    EXPECT_EQ(said.exit_code, 3) << command;
    EXPECT_EQ(said.err.find("prehend: found a stack of 64 KiB, wanted 1024 KiB: see ulimit -s\n"),
              0u)
        << command << "\n"
        << said.err;
  }
  EXPECT_EQ(DoAfter("ulimit -S -s 64", "list").exit_code, 0) << "it may raise its own limit";
}

TEST_F(Preconditions, AFolderThatCannotBeReadIsNotEmpty) {
  const Said said = DoAfter("exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; ulimit -n 4", "list");
  EXPECT_EQ(said.exit_code, 3) << said.out;
  EXPECT_NE(said.err.find("cannot be read: Too many open files"), std::string::npos) << said.err;
  if (geteuid() == 0) return;  // who may read everything
  const fs::path folder = Scenario().parent_path();
  fs::permissions(folder, fs::perms::none);
  const Said denied = Do("check --no-pictures");
  fs::permissions(folder, fs::perms::owner_all);
  EXPECT_EQ(denied.exit_code, 2) << denied.out;
  EXPECT_NE(denied.err.find("scenarios or a folder in it cannot be read: Permission denied"),
            std::string::npos)
      << denied.err;
}

TEST_F(Preconditions, AnOutputReplacesNoInput) {
  Accept();
  const std::string golden = ReadFile(Golden()), scenario = ReadFile(Scenario());
  for (const std::string& command :
       {"check --no-pictures --junit " + Golden().string(),
        "run carton_rests --record " + Scenario().string(),
        "run carton_rests --record " +
            (root_ / "golden/../scenarios/rest/carton_rests.yaml").string(),
        "render carton_rests -o " + Scenario().string()}) {
    const Said said = Do(command);
    EXPECT_EQ(said.exit_code, 2) << command;
    EXPECT_NE(said.err.find("is a file of the project's "), std::string::npos) << said.err;
  }
  EXPECT_EQ(ReadFile(Golden()), golden);
  EXPECT_EQ(ReadFile(Scenario()), scenario);
  const fs::path recording = root_ / "a.csv";
  WriteFile(recording, "time\n");
  const Said said =
      Do("grammar tracks " + recording.string() + " -o " + (root_ / "./a.csv").string());
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("a.csv is what is read; name another file"), std::string::npos)
      << said.err;
  EXPECT_EQ(ReadFile(recording), "time\n");
  EXPECT_EQ(Do("check --no-pictures --junit " + (root_ / "junit.xml").string()).exit_code, 0);
  EXPECT_EQ(Do("check --no-pictures --junit " + (root_ / "junit.xml").string()).exit_code, 0)
      << "what was written before may be written again";
}

// Found in a folder, named in a file of takes, used by a grammar, met in an export.
TEST_F(Preconditions, NorWhatIsReadWithoutBeingNamed) {
  const std::string at = root_.string() + "/";
  const auto copy = [&](const std::string& from, const std::string& to) {
    fs::create_directories((root_ / to).parent_path());
    fs::copy_file(from, root_ / to);
  };
  const std::string poses = PREHEND_SOURCE_DIR "/docs/motion_capture/";
  for (const std::string take : {"milk.jsonl", "folder/take.jsonl", "other/milk.jsonl"})
    ASSERT_EQ(Do("import " + poses + "poses.csv --map " + poses + "bodies.yaml -o " + at + take)
                  .exit_code,
              0);
  copy(poses + "labels.csv", "labels.csv");
  copy(poses + "labels.csv", "truth/take.csv");
  copy(poses + "labels.yaml", "labels.yaml");
  WriteFile(root_ / "base.grammar", "grammar base\nuse pick_and_place_from_motion\n");
  WriteFile(root_ / "top.grammar", "grammar top\nuse base\n");
  WriteFile(root_ / "takes.yaml",
            "map: labels.yaml\ntakes: [{recording: milk.jsonl, labels: labels.csv}]\n");
  const std::string takes = at + "takes.yaml", over = " --over reach_radius=10cm..20cm:2 -o ",
                    folder = at + "folder", truth = " --truth " + at + "truth --map " + at;
  for (const auto& [command, output] : std::vector<std::pair<std::string, std::string>>{
           {"report " + folder + " -o ", "folder/take.jsonl"},
           {"report " + folder + truth + "labels.yaml -o ", "truth/take.csv"},
           {"report " + takes + " -o ", "milk.jsonl"},
           {"report " + takes + " -o ", "labels.csv"},
           {"report " + takes + " -o ", "labels.yaml"},
           {"report " + at + "milk.jsonl --grammar " + at + "top.grammar -o ", "base.grammar"},
           {"grammar sweep " + takes + over, "labels.csv"},
           {"grammar sweep " + folder + truth + "labels.yaml" + over, "truth/take.csv"},
           {"grammar margins " + takes + " --over reach_radius -o ", "labels.csv"},
           {"episode resegment " + takes + " -o ", "labels.csv"},
           {"episode export " + at + "milk.jsonl --to jsonl -o ", "."},
           {"episode export " + at + "milk.jsonl " + at + "other/milk.jsonl --to jsonl -o ",
            "other"}}) {
    const std::map<std::string, std::string> before = FilesBelow(root_);
    const Said said = Do(command + at + output);
    EXPECT_EQ(said.exit_code, 2) << command << output << said.out;
    EXPECT_NE(said.err.find("is what is read; name another file"), std::string::npos)
        << command << output << said.err;
    EXPECT_TRUE(FilesBelow(root_) == before) << command << output;
  }
  EXPECT_EQ(Do("report " + takes + " -o " + at + "page.html").exit_code, 0);
  EXPECT_EQ(Do("report " + takes + " -o " + at + "page.html").exit_code, 0);
}

TEST_F(Preconditions, NorAnotherOutput) {
  Accept();
  const std::string one = (root_ / "one.episodes").string(), page = (root_ / "page").string();
  for (const std::string& command :
       {"check --no-pictures --record " + one + " --junit " + (root_ / "./one.episodes").string(),
        "check --no-pictures --report " + page + " --junit " + page + "/index.html"}) {
    const Said said = Do(command);
    EXPECT_EQ(said.exit_code, 2) << command;
    EXPECT_NE(said.err.find(" writes; name another file"), std::string::npos) << said.err;
    EXPECT_FALSE(fs::exists(one) || fs::exists(page)) << command;
  }
  EXPECT_EQ(
      Do("check --no-pictures --report " + page + " --junit " + page + "/junit.xml").exit_code, 0);
}

// Nobody writes into the pipe, and the device never ends.
TEST_F(Preconditions, APipeOrADeviceIsNoRecording) {
  const fs::path pipe = root_ / "pipe.jsonl", device = root_ / "device.jsonl",
                 poses = root_ / "poses.csv", map = root_ / "map.yaml";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(poses.c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", device);
  WriteFile(map, ReadFile(PREHEND_SOURCE_DIR "/docs/motion_capture/bodies.yaml"));
  for (const std::string& command :
       {"episode resegment " + pipe.string(), "episode resegment " + device.string(),
        "explain " + pipe.string(), "explain " + device.string(),
        "import " + poses.string() + " --check --map " + map.string(),
        "import " + poses.string() + " --propose"}) {
    const Said said = DoAfter("ulimit -t 10", command + " --time-limit-s 20");
    EXPECT_EQ(said.exit_code, 2) << command << said.err;
    EXPECT_NE(said.err.find("is not a regular file"), std::string::npos) << command << said.err;
  }
}

TEST_F(Preconditions, NorAFolderOfTheProject) {
  Accept();
  const std::string file = (root_ / "a.episodes").string(), kb = (root_ / "kb").string();
  ASSERT_EQ(Do("run carton_rests --record " + file).exit_code, 0);
  ASSERT_EQ(Do("episode knowledge " + file + " -o " + kb).exit_code, 0);
  for (const std::string folder : {"golden", "scenarios/rest", "grammars/own"}) {
    const std::string there = (root_ / folder).string();
    for (const std::string& command :
         {"episode knowledge " + file + " -o " + there,
          "episode query " + file + " --event contact --show " + there,
          "episode ask " + kb + " true --show " + there, "check --report " + there}) {
      const Said said = Do(command);
      EXPECT_EQ(said.exit_code, 2) << command;
      EXPECT_NE(said.err.find("a file of the project's "), std::string::npos) << said.err;
    }
  }
  EXPECT_FALSE(fs::exists(root_ / "grammars/own"));
}

TEST_F(Preconditions, FewDescriptorsAreNoReasonToWait) {
  Accept();
  for (const char* count : {"4", "5", "6", "7"}) {
    const Said said =
        DoAfter(std::string("exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; ulimit -n ") + count,
                "check --no-pictures");
    EXPECT_TRUE(said.exit_code == 0 || said.exit_code == 3) << count << said.err;
    const bool says = (said.out + said.err).find("Too many open files") != std::string::npos;
    EXPECT_TRUE(said.exit_code == 0 || says) << count << said.out << said.err;
  }
}

TEST_F(Preconditions, WhatTheMachineLacksIsNoBadInput) {
  Accept();
  const std::string file = (root_ / "a.episodes").string(), kb = (root_ / "kb").string();
  ASSERT_EQ(Do("run carton_rests --record " + file).exit_code, 0);
  ASSERT_EQ(Do("episode knowledge " + file + " -o " + kb).exit_code, 0);
  const std::string closed = "exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; ulimit -n ";
  for (const char* count : {"4", "5", "6", "7", "8"}) {
    for (const std::string& command :
         {"episode verify " + file, "report " + file + " -o " + (root_ / "page.html").string(),
          "episode ask " + kb + " true", "episode resegment " + file}) {
      const Said said = DoAfter(closed + count, command);
      EXPECT_TRUE(said.exit_code == 0 || said.exit_code == 3) << count << command << said.err;
      const bool says = said.err.find("Too many open files") != std::string::npos;
      EXPECT_TRUE(said.exit_code == 0 || says) << count << command << said.err;
    }
  }
  const Said said = DoAfter("export TMPDIR=/nonexistent", "episode verify " + file);
  EXPECT_EQ(said.exit_code, 3) << said.err;
  EXPECT_NE(said.err.find("no folder for temporary files"), std::string::npos) << said.err;
}

// Nobody writes into the pipe: who opens it waits for ever.
TEST_F(Preconditions, APipeIsNotWaitedFor) {
  Accept();
  const fs::path pipe = root_ / "scenarios/rest/pipe.yaml";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const char* command : {"list", "validate", "check --no-pictures --time-limit-s 20"}) {
    const Said said = Do(command);
    EXPECT_EQ(said.exit_code, 2) << command;
    EXPECT_NE((said.out + said.err).find("pipe.yaml: error: is not a regular file"),
              std::string::npos)
        << command << "\n"
        << said.err;
  }
  fs::remove(pipe);
  fs::remove(Golden());
  ASSERT_EQ(mkfifo(Golden().c_str(), 0600), 0);
  for (const char* command :
       {"validate", "check --no-pictures --time-limit-s 20", "accept carton_rests --reason why"}) {
    const Said said = Do(command);
    EXPECT_EQ(said.exit_code, 2) << command;
    EXPECT_NE((said.out + said.err).find("carton_rests.timeline: error: is not a regular file"),
              std::string::npos)
        << command << "\n"
        << said.err;
  }
  fs::remove(Golden());
  fs::create_directories(root_ / "build/check");
  fs::remove(root_ / "build/check/costs.json");
  ASSERT_EQ(mkfifo((root_ / "build/check/costs.json").c_str(), 0600), 0);
  EXPECT_EQ(Do("check --no-pictures").exit_code, 5);
}

TEST_F(Preconditions, TwoDashesEndTheOptions) {
  EXPECT_EQ(Do("run -- carton_rests").exit_code, 0);
  EXPECT_EQ(Do("run --json -- carton_rests").exit_code, 0);
  const Said said = Do("run -- --json");
  EXPECT_EQ(said.exit_code, 4) << said.err;
  EXPECT_NE(said.err.find("no scenario '--json'"), std::string::npos) << said.err;
}

TEST_F(Preconditions, LimitsOfTimeAndMemoryEndEveryCommandThatPlays) {
  WriteVariant("rest/long", "wait_s: 0.2", "wait_s: 290");
  for (const std::string& command :
       {std::string("accept long --reason why"), std::string("score")}) {
    const Said late = Do(command + " --time-limit-s 0.2");
    EXPECT_EQ(late.exit_code, 3) << command;
    EXPECT_NE(late.err.find("no end after 0.2 s"), std::string::npos) << late.err;
    const Said large = Do(command + " --memory-limit-mb 1");
    EXPECT_EQ(large.exit_code, 3) << command;
    EXPECT_NE(large.err.find("MB"), std::string::npos) << large.err;
  }
  EXPECT_FALSE(fs::exists(Golden("rest/long")));
}

}  // namespace
}  // namespace prehend::house

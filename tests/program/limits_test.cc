// SPDX-License-Identifier: Apache-2.0
// Commands that read what anybody may have written end within limits, by an exit code of their own.
#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

class Limits : public SmallProject {
 protected:
  /// A settled carton.
  std::string Long() const {
    WriteVariant("rest/long", "wait_s: 0.2", "wait_s: 290");
    return "long";
  }
};

TEST_F(Limits, OfTimeEndARun) {
  const Said said = Do("run " + Long() + " --time-limit-s 0.2");
  EXPECT_EQ(said.exit_code, 3);
  EXPECT_EQ(said.out, "");
  EXPECT_NE(said.err.find("no end after 0.2 s"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("again: prehend run long"), std::string::npos) << said.err;
}

TEST_F(Limits, OfMemoryEndARun) {
  const Said said = Do("run carton_rests --memory-limit-mb 1");
  EXPECT_EQ(said.exit_code, 3);
  EXPECT_NE(said.err.find("MB"), std::string::npos) << said.err;
  EXPECT_EQ(Do("run carton_rests --memory-limit-mb 0 --time-limit-s 0").exit_code, 0);
}

// Two hundred rules that are looked at in every frame.
TEST_F(Limits, OfTimeEndARecordingsSegmentation) {
  const std::string path = (root_ / "some.jsonl").string();
  ASSERT_EQ(Do("run " + Long() + " --set script.0.right_hand.wait_s=20 --record " + path).exit_code,
            0);
  std::string grammar = "grammar slow\n";
  for (int i = 0; i < 200; ++i)
    grammar += "event e" + std::to_string(i) +
               "(a: Entity, b: Entity) while distance(a, b) < 1 m and rate(height(a), " +
               std::to_string(i + 1) + " ms) > 1 m/s\n";
  WriteFile(root_ / "slow.grammar", grammar);
  const Said said = Do("episode resegment " + path + " --grammar " +
                       (root_ / "slow.grammar").string() + " --time-limit-s 0.1");
  EXPECT_EQ(said.exit_code, 3) << said.err;
  EXPECT_NE(said.err.find("no end after 0.1 s"), std::string::npos) << said.err;
}

TEST_F(Limits, OfTheSizeOfFilesEndACommandWithACode) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "carton_rests", "--record",
                                 (root_ / "x.episodes").string()},
        {"run", "carton_rests", "--record", (root_ / "x.jsonl").string()},
        {"check", "--no-pictures", "--report", (root_ / "page").string()}}) {
    const Said said = Prehend(words, {"PREHEND_HOME=" + root_.string()}, "ulimit -f 4");
    EXPECT_TRUE(said.exit_code == 3 || said.exit_code == 2) << said.exit_code << said.err;
    EXPECT_EQ(said.err.find("prehend: "), 0u) << said.err;
  }
}

TEST_F(Limits, AreExplained) {
  const std::string help = Do("--help").out;
  EXPECT_NE(help.find("default: 600,"), std::string::npos) << help;
  EXPECT_NE(help.find("with --trials or --on-save none"), std::string::npos) << help;
}

}  // namespace
}  // namespace prehend::house

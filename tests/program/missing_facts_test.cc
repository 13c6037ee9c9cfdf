// SPDX-License-Identifier: Apache-2.0
// Recordings of poses alone, shown to grammars that ask for more.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kPoses =
    R"({"recording": 1, "episode": "poses", "ticks_per_second": 100, "entities": {"table": {"fixed": true, "size_m": [1, 1, 0.04]}, "cup": {"size_m": [0.1, 0.1, 0.1]}, "hand": {"hand": true, "size_m": [0, 0, 0]}}}
{"tick": 0, "samples": {"cup": {"at_m": [0, 0, 0.07]}, "hand": {"at_m": [0, 0, 1]}}}
{"tick": 50, "samples": {"hand": {"at_m": [0, 0, 0.5]}}}
{"end_tick": 100}
)";

TEST(MissingFacts, AreNamedAndNothingRecognisedIsExitCodeFour) {
  const auto file = FreshFolder("missing") / "poses.jsonl";
  WriteFile(file, kPoses);
  const Said said = Prehend({"episode", "resegment", file.string(), "--grammar", "pick_and_place"});
  EXPECT_EQ(said.exit_code, 4);
  EXPECT_TRUE(said.err.starts_with(
      "warning: no frame says where 'table' is, so no condition on its pose ever holds\n"))
      << said.err;
  EXPECT_NE(said.err.find("contact.grammar:10:17: warning: this recording has no touches, so "
                          "'contact' is never recognised, nor supported_by, grasping, "),
            std::string::npos)
      << said.err;
  EXPECT_NE(said.err.find("use contact from motion"), std::string::npos);
}

TEST(MissingFacts, NoTrackIsExitCodeFourAndNothingIsWritten) {
  const auto folder = FreshFolder("missing");
  WriteFile(folder / "poses.jsonl", kPoses);
  const std::string tracks = (folder / "tracks.csv").string();
  const Said said = Prehend({"grammar", "tracks", (folder / "poses.jsonl").string(), "--grammar",
                             "pick_and_place", "-o", tracks});
  EXPECT_EQ(said.exit_code, 4);
  EXPECT_EQ(said.out, "");
  EXPECT_NE(said.err.find("no track: nothing that the grammar looks at is in this episode"),
            std::string::npos)
      << said.err;
  EXPECT_FALSE(std::filesystem::exists(tracks));
}

TEST(MissingFacts, WhatCanStillBeRecognisedIsExitCodeZero) {
  const auto folder = FreshFolder("missing");
  WriteFile(folder / "poses.jsonl", kPoses);
  WriteFile(folder / "g.grammar",
            "grammar g\nuse grasp\nevent down(hand: Hand) while vertical_speed(hand) < -10 cm/s\n");
  const Said said = Prehend({"episode", "resegment", (folder / "poses.jsonl").string(), "--grammar",
                             (folder / "g.grammar").string()});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.err.find("so 'grasping' is never recognised\n"), std::string::npos) << said.err;
  EXPECT_NE(said.out.find("down"), std::string::npos);
  const Said motion = Prehend({"episode", "resegment", (folder / "poses.jsonl").string(),
                               "--grammar", "pick_and_place_from_motion"});
  EXPECT_EQ(motion.exit_code, 0);
  EXPECT_EQ(motion.err.find("never recognised"), std::string::npos) << motion.err;
}

TEST(MissingFacts, ForcesAreNotMadeOfMotion) {
  const auto folder = FreshFolder("missing");
  WriteFile(folder / "poses.jsonl", kPoses);
  WriteFile(folder / "g.grammar", "grammar g\nuse contact from motion\nuse kitchen\n");
  const Said said = Prehend({"episode", "resegment", (folder / "poses.jsonl").string(), "--grammar",
                             (folder / "g.grammar").string()});
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.err.find("warning: this recording has no forces, so 'holding_onto' is never "
                          "recognised\n  hint: motion does not show forces: give touches "
                          "'force_n', or leave these events out\n"),
            std::string::npos)
      << said.err;
  // What asks for touches themselves is not told to use what it uses.
  EXPECT_NE(said.err.find("so 'opened_by' is never recognised, nor closed_by\n  hint: these rules "
                          "ask for what was measured; contact(a, b), supported_by(a, b) and "
                          "grasping(a, b) are made of motion\n"),
            std::string::npos)
      << said.err;
  EXPECT_EQ(said.err.find("make these facts of motion"), std::string::npos) << said.err;
  // Of an episode file the grammar is called as it was.
  WriteFile(folder / "g.grammar",
            "grammar g\nuse contact from motion\n"
            "event press(a: Thing, b: Thing) while force(a, b) > 1 N\n");
  Prehend({"import", (folder / "poses.jsonl").string(), "--grammar",
           (folder / "g.grammar").string(), "-o", (folder / "kept.episodes").string()});
  const Said kept = Prehend({"episode", "resegment", (folder / "kept.episodes").string()});
  EXPECT_NE(kept.err.find("\n" + (folder / "g.grammar").string() +
                          ":3:7: warning: this recording "
                          "has no forces, so 'press' is never recognised\n"),
            std::string::npos)
      << kept.err;
}

// Poses without a single orientation: nothing is ever tipped.
TEST(MissingFacts, WithoutOrientationsThereIsNoPouring) {
  const auto folder = FreshFolder("missing");
  WriteFile(folder / "g.grammar", "grammar g\nuse contact from motion\nuse pouring\n");
  WriteFile(folder / "labels.csv", "begin_s,end_s,label\n0.1,0.5,pouring\n");
  const std::string poses = (folder / "poses.jsonl").string();
  const std::vector<std::vector<std::string>> calls = {
      {"episode", "resegment", poses},
      {"score", poses, "--truth", (folder / "labels.csv").string()}};
  const auto say = [&](const std::vector<std::string>& call, const std::string& text) {
    WriteFile(folder / "poses.jsonl", text);
    std::vector<std::string> words = call;
    words.insert(words.end(), {"--grammar", (folder / "g.grammar").string()});
    return Prehend(words).err;
  };
  const std::string warning =
      "warning: this recording has no orientations, so 'pouring' is never recognised\n  hint: "
      "nothing ever turns in it: give samples 'quat_wxyz'";
  std::string turned = kPoses;
  turned.replace(turned.find("\"at_m\": [0, 0, 0.07]"), 21,
                 "\"at_m\": [0, 0, 0.07], \"quat_wxyz\": [0.8, 0.6, 0, 0]");
  for (const auto& call : calls) {
    const std::string said = say(call, kPoses);
    EXPECT_NE(said.find(warning), std::string::npos) << said;
    EXPECT_EQ(said.find("no orientations", said.find(warning) + warning.size()), std::string::npos)
        << "said once\n"
        << said;
    const std::string with = say(call, turned);
    EXPECT_EQ(with.find("orientations"), std::string::npos) << with;
  }
}

}  // namespace
}  // namespace prehend::house

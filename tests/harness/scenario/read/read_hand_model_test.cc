// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "harness/scenario/read/read_scenario.h"

namespace prehend::scenario {
namespace {

namespace fs = std::filesystem;

const std::string kLibrary = PREHEND_SOURCE_DIR "/physics/library/";

std::string ReadWhole(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream stream;
  stream << file.rdbuf();
  return stream.str();
}

/// A folder with the library's hands, which may be changed.
class HandFolder {
 public:
  HandFolder()
      : folder_(fs::temp_directory_path() /
                ("prehend_read_hand_model_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::copy(kLibrary, folder_);
  }
  ~HandFolder() { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  /// Replaces a text in whichever of these files has it.
  void Change(const std::vector<std::string>& names, const std::string& what,
              const std::string& by) const {
    for (const std::string& name : names) {
      std::string text = ReadWhole(folder_ / name);
      const std::size_t at = text.find(what);
      if (at != std::string::npos) return Write(name, text.replace(at, what.size(), by));
    }
    ADD_FAILURE() << what << " is in no file";
  }

 private:
  fs::path folder_;
};

/// The shipped hand with one text replaced, in its own file or in that of its grasps.
Result<physics::HandModel> ReadChanged(const std::string& what, const std::string& by,
                                       const std::string& hand = "human_right") {
  const HandFolder folder;
  folder.Change({hand + ".hand.yaml", "human.grasps.yaml"}, what, by);
  return ReadHandModel(folder.Path(hand + ".hand.yaml"));
}

TEST(ReadHandModelTest, TheLibrarysHandsAreWhole) {
  for (const char* name : {"human_right", "human_left"}) {
    const auto hand = ReadHandModel(kLibrary + name + ".hand.yaml");
    ASSERT_TRUE(hand.has_value()) << Format(ErrorsOf(hand).front());
    EXPECT_EQ(hand->name, name);
    EXPECT_EQ(hand->links.size(), 16u);
    for (const char* style : {"wrap", "medium_wrap", "pinch", "tripod", "lateral", "hook", "flat"})
      EXPECT_GE(physics::FindStyle(*hand, style), 0) << style;
    EXPECT_EQ(physics::CheckGains(*hand, 480), "");
    for (const auto& style : hand->styles) EXPECT_EQ(style.effort.size(), 16u);
  }
}

struct Mistake {
  const char* what;
  const char* by;
  const char* message;
};

TEST(ReadHandModelTest, MistakesAreNamedAtTheirPlace) {
  const Mistake mistakes[] = {
      {"hand: human_right", "hand: human", "the file is called"},
      {"sensor_set: fingers", "sensor_set: finger", "'finger' is not in sensor_sets"},
      {"index: [25, 15, 5]", "index: [25, 15]", "expected 3 numbers"},
      {"index: [25, 15, 5]", "indes: [25, 15, 5]", "no digit 'indes'"},
      {"direction: [1, 0, 0]", "direction: [0, 0, 0]", "a direction other than"},
      {"range_deg: [-20, 95]", "range_deg: [95, -20]",
       "range_deg: expected [min, max], found [95, -20]"},
      {"stiffness: 0.2", "stiffnes: 0.2", "stiffnes"},
      {"grasps: [human]", "grasps: [humen]",
       "grasps: there is no humen.grasps.yaml beside this file, in "},
      {"grasps: [human]", "", "the hand has no grasp style"},
      {"grasps: human", "grasps: people",
       "grasps: the name is 'people', but the file is called 'human.grasps.yaml'"},
      {"mass_kg: 0.6", "mass_kg: -0.6", "mass_kg"},
  };
  for (const Mistake& mistake : mistakes) {
    const auto result = ReadChanged(mistake.what, mistake.by);
    ASSERT_FALSE(result.has_value()) << mistake.by;
    const std::string text = Format(result.error().front());
    EXPECT_NE(text.find(mistake.message), std::string::npos) << text;
    EXPECT_GT(result.error().front().place.line, 0) << text;
  }
}

TEST(ReadHandModelTest, JawsSlideAndAreCheckedAlike) {
  const auto hand = ReadHandModel(kLibrary + "planar_gripper.hand.yaml");
  ASSERT_TRUE(hand.has_value()) << Format(ErrorsOf(hand).front());
  EXPECT_EQ(physics::CheckGains(*hand, 240), "");
  ASSERT_EQ(hand->links.size(), 2u);
  EXPECT_TRUE(hand->links[1].slides);
  EXPECT_EQ(hand->links[1].strength, 15);
  EXPECT_EQ(hand->styles[0].frames[1][0], 0.012) << "metres";
  const Mistake mistakes[] = {
      {"- {post: [0], jaw: [0]}", "- {post: [0]}", "digit 'jaw' is missing"},
      {"range_m: [0, 0.045]", "range_m: [0.045, 0]",
       "range_m: expected [min, max], found [0.045, 0]"},
      {"    frames_m:", "    frames_deg:", "style 'parallel' has no 'frames_m'"},
      {"strength_n: 45", "strength_nm: 45", "strength_n"},
      {"slides: [1, 0, 0]", "slides: [0, 0, 0]", "a direction other than"},
  };
  for (const Mistake& mistake : mistakes) {
    const auto result = ReadChanged(mistake.what, mistake.by, "planar_gripper");
    ASSERT_FALSE(result.has_value()) << mistake.by;
    EXPECT_NE(Format(ErrorsOf(result)).find(mistake.message), std::string::npos)
        << Format(ErrorsOf(result));
  }
}

constexpr const char* kTwoGrasps = R"(grasps: mine
styles:
  firm:
    grip: {axis: [1, 0, 0], post_m: [0.01, 0, 0], opening_m: 0.08}
    above: {toward: [0, 0, -1], palm_gap_m: 0.02, pads_m: 0.08, floor_m: 0.1}
    effort: {index: [0.5], middle: [0.5], ring: [0.5], little: [0.5], thumb: [1.6]}
    frames_deg:
      - {index: [1, 2, 3], middle: [1, 2, 3], ring: [1, 2, 3], little: [1, 2, 3], thumb: [1, 2, 3, 4]}
      - {index: [4, 5, 6], middle: [4, 5, 6], ring: [4, 5, 6], little: [4, 5, 6], thumb: [5, 6, 7, 8]}
  wrap:
    grip: {axis: [1, 0, 0], post_m: [0, 0.02, 0]}
    side: {toward: [0, 0, -1], up: [0, 1, 0], palm_gap_m: 0.02, pads_m: 0.08, floor_m: 0.1}
    effort: {index: [0.5], middle: [0.5], ring: [0.5], little: [0.5], thumb: [1.6]}
    frames_deg:
      - {index: [1, 2, 3], middle: [1, 2, 3], ring: [1, 2, 3], little: [1, 2, 3], thumb: [1, 2, 3, 4]}
      - {index: [4, 5, 6], middle: [4, 5, 6], ring: [4, 5, 6], little: [4, 5, 6], thumb: [5, 6, 7, 8]}
)";

TEST(ReadHandModelTest, AGraspFileAddsStylesAndReplacesThem) {
  const HandFolder folder;
  folder.Write("mine.grasps.yaml", kTwoGrasps);
  const auto before = ReadHandModel(folder.Path("human_right.hand.yaml"));
  std::vector<std::string> files;
  const auto hand = ReadHandModel(folder.Path("human_right.hand.yaml"),
                                  {folder.Path("mine.grasps.yaml")}, &files);
  ASSERT_TRUE(hand.has_value()) << Format(ErrorsOf(hand));
  ASSERT_EQ(hand->styles.size(), before->styles.size() + 1);
  const int firm = physics::FindStyle(*hand, "firm"), wrap = physics::FindStyle(*hand, "wrap");
  ASSERT_GE(firm, 0);
  EXPECT_EQ(wrap, physics::FindStyle(*before, "wrap")) << "it takes the other's place";
  EXPECT_FALSE(hand->styles[static_cast<std::size_t>(wrap)].above)
      << "nothing of the other is left";
  EXPECT_NEAR(hand->styles[static_cast<std::size_t>(firm)].frames[1][0], 0.0698, 1e-4) << "radians";
  EXPECT_EQ(files, (std::vector<std::string>{folder.Path("human_right.hand.yaml"),
                                             folder.Path("human.grasps.yaml"),
                                             folder.Path("mine.grasps.yaml")}));
}

TEST(ReadHandModelTest, TheGraspsOfAMirroredHandAreMirrored) {
  const HandFolder folder;
  folder.Write("mine.grasps.yaml", kTwoGrasps);
  std::vector<std::string> files;
  const auto hand =
      ReadHandModel(folder.Path("human_left.hand.yaml"), {folder.Path("mine.grasps.yaml")}, &files);
  ASSERT_TRUE(hand.has_value()) << Format(ErrorsOf(hand));
  EXPECT_NEAR(hand->styles[static_cast<std::size_t>(physics::FindStyle(*hand, "wrap"))].post_m.y(),
              -0.02, 1e-12);
  EXPECT_EQ(files.size(), 4u)
      << "of the original and of its grasps, too: when they change, so does this hand";
}

TEST(ReadHandModelTest, MistakesInAGraspFileAreNamedThere) {
  const HandFolder folder;
  folder.Write("mine.grasps.yaml", kTwoGrasps);
  folder.Change({"mine.grasps.yaml"}, "little: [4, 5, 6]", "litle: [4, 5, 6]");
  const auto hand =
      ReadHandModel(folder.Path("human_left.hand.yaml"), {folder.Path("mine.grasps.yaml")});
  ASSERT_FALSE(hand.has_value());
  const std::string text = Format(ErrorsOf(hand));
  EXPECT_NE(text.find("mine.grasps.yaml:9:"), std::string::npos) << text;
  EXPECT_NE(text.find("the hand has no digit 'litle'"), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean 'little'?"), std::string::npos) << text;
}

TEST(ReadHandModelTest, AMissingFileIsADiagnostic) {
  EXPECT_FALSE(ReadHandModel(kLibrary + "tentacle.hand.yaml").has_value());
}

}  // namespace
}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
#include "harness/read_hand_model.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace prehend::harness {
namespace {

const std::string kLibrary = PREHEND_SOURCE_DIR "/physics/library/";

/// The shipped hand with one text replaced, read from a file of the same name.
ReadResult<physics::HandModel> ReadChanged(const std::string& what, const std::string& by,
                                           const std::string& hand = "human_right") {
  std::ifstream file(kLibrary + hand + ".hand.yaml");
  std::stringstream stream;
  stream << file.rdbuf();
  std::string text = stream.str();
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
  const auto folder = std::filesystem::temp_directory_path() / ("prehend_read_hand_model_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = (folder / (hand + ".hand.yaml")).string();
  std::ofstream(path) << text;
  auto result = ReadHandModel(path);
  std::filesystem::remove_all(folder);
  return result;
}

TEST(ReadHandModelTest, TheLibrarysHandsAreWhole) {
  for (const char* name : {"human_right", "human_left"}) {
    const auto hand = ReadHandModel(kLibrary + name + ".hand.yaml");
    ASSERT_TRUE(hand.value.has_value()) << Format(hand.diagnostics.front());
    EXPECT_EQ(hand.value->name, name);
    EXPECT_EQ(hand.value->links.size(), 16u);
    for (const char* style : {"wrap", "medium_wrap", "pinch", "tripod", "lateral", "hook"})
      EXPECT_GE(physics::FindStyle(*hand.value, style), 0) << style;
    EXPECT_EQ(physics::CheckGains(*hand.value, 480), "");
    for (const auto& style : hand.value->styles) EXPECT_EQ(style.effort.size(), 16u);
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
      {"range_deg: [-20, 95]", "range_deg: [95, -20]", "[least, most]"},
      {"stiffness: 0.2", "stiffnes: 0.2", "stiffnes"},
      {"mass_kg: 0.6", "mass_kg: -0.6", "mass_kg"},
  };
  for (const Mistake& mistake : mistakes) {
    const auto result = ReadChanged(mistake.what, mistake.by);
    ASSERT_FALSE(result.value.has_value()) << mistake.by;
    const std::string text = Format(result.diagnostics.front());
    EXPECT_NE(text.find(mistake.message), std::string::npos) << text;
    EXPECT_GT(result.diagnostics.front().place.line, 0) << text;
  }
}

TEST(ReadHandModelTest, JawsSlideAndAreCheckedAlike) {
  const auto hand = ReadHandModel(kLibrary + "planar_gripper.hand.yaml");
  ASSERT_TRUE(hand.value.has_value()) << Format(hand.diagnostics.front());
  EXPECT_EQ(physics::CheckGains(*hand.value, 240), "");
  ASSERT_EQ(hand.value->links.size(), 2u);
  EXPECT_TRUE(hand.value->links[1].slides);
  EXPECT_EQ(hand.value->links[1].strength, 15);
  EXPECT_EQ(hand.value->styles[0].frames[1][0], 0.012) << "metres";
  const Mistake mistakes[] = {
      {"- {post: [0], jaw: [0]}", "- {post: [0]}", "there is nothing for digit 'jaw'"},
      {"range_m: [0, 0.045]", "range_m: [0.045, 0]", "range_m: expected [least, most]"},
      {"    frames_m:", "    frames_deg:", "style 'parallel' has no 'frames_m'"},
      {"strength_n: 45", "strength_nm: 45", "strength_n"},
      {"slides: [1, 0, 0]", "slides: [0, 0, 0]", "a direction other than"},
  };
  for (const Mistake& mistake : mistakes) {
    const auto result = ReadChanged(mistake.what, mistake.by, "planar_gripper");
    ASSERT_FALSE(result.value.has_value()) << mistake.by;
    EXPECT_NE(Format(result.diagnostics).find(mistake.message), std::string::npos)
        << Format(result.diagnostics);
  }
}

TEST(ReadHandModelTest, AMissingFileIsADiagnostic) {
  EXPECT_FALSE(ReadHandModel(kLibrary + "tentacle.hand.yaml").value.has_value());
}

}  // namespace
}  // namespace prehend::harness

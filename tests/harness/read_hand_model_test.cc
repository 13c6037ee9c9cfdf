// SPDX-License-Identifier: Apache-2.0
#include "harness/read_hand_model.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace prehend::harness {
namespace {

const std::string kLibrary = PREHEND_SOURCE_DIR "/physics/library/";

/// The shipped hand with one text replaced, read from a file of the same name.
ReadResult<physics::HandModel> ReadChanged(const std::string& what, const std::string& by) {
  std::ifstream file(kLibrary + "human_right.hand.yaml");
  std::stringstream stream;
  stream << file.rdbuf();
  std::string text = stream.str();
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
  const auto folder = std::filesystem::temp_directory_path() / "prehend_read_hand_model_test";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "human_right.hand.yaml").string();
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

TEST(ReadHandModelTest, AMissingFileIsADiagnostic) {
  EXPECT_FALSE(ReadHandModel(kLibrary + "tentacle.hand.yaml").value.has_value());
}

}  // namespace
}  // namespace prehend::harness

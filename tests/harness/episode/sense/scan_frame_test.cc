// SPDX-License-Identifier: Apache-2.0
// The short way to a frame gives what the field tables give, or nothing.
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>
#include <variant>

#include "harness/base/yaml/located_yaml.h"
#include "harness/episode/sense/episode_format.h"

namespace prehend::episode {
namespace {

// What the field tables say; nothing if the line has a mistake or is no frame.
std::optional<FrameEntry> FromTables(const std::string& line) {
  static const ValueFormat<LineEntry> format = LineFormat();
  const auto document = ParseJson("a.jsonl", line);
  if (!document) return std::nullopt;
  DiagnosticList errors(*document);
  LineEntry entry;
  if (!format.Read(document->root, errors, entry) || !errors.empty()) return std::nullopt;
  const auto* frame = std::get_if<FrameEntry>(&entry);
  return frame == nullptr ? std::nullopt : std::optional(*frame);
}

// All numbers to the last bit.
std::string TextOf(const FrameEntry& frame) {
  std::string text = std::to_string(frame.tick.value);
  const auto add = [&](const auto& vector) {
    for (const double number : vector)
      text += " " + std::to_string(std::bit_cast<std::uint64_t>(number));
  };
  for (const auto& [name, where, sample] : frame.samples) {
    text += "\n" + name;
    add(sample.at_m);
    if (sample.quat_wxyz) text += " q", add(sample.quat_wxyz->value);
    if (sample.v_m_per_s) text += " v", add(*sample.v_m_per_s);
    if (sample.w_rad_per_s) text += " w", add(*sample.w_rad_per_s);
    text += sample.asleep ? " asleep" : "";
    add(Eigen::Vector2d(sample.joint_position, sample.joint_fraction));
    if (sample.gazes_at) text += " " + sample.gazes_at->value;
  }
  for (const auto& [name, where, hand] : frame.hands) {
    text += "\n" + name;
    add(Eigen::Matrix<double, 1, 1>(hand.trigger));
    if (hand.ahead) text += " ahead", add(*hand.ahead);
    for (const Eigen::Vector4d& sphere : hand.collision_spheres_m) text += " sphere", add(sphere);
    if (hand.style) text += " " + hand.style->value;
  }
  return text + "\n" + std::to_string(frame.touches.size());
}

const std::string kLines[] = {
    R"({"tick": 0})",
    R"({"tick":-12,"samples":{}})",
    R"({"tick": 7, "samples": {"cup": {"at_m": [0.1, -2, 3e-2], "quat_wxyz": [1.0, 0, -0.0, 0]}}})",
    R"({"samples":{"a":{"at_m":[0.09950000000000003,1E+2,-0]},"b":{"quat_wxyz":[0.5,0.5,-0.5,0.5],"at_m":[0,0,0]}},"tick":125})",
    R"({"tick":1,"samples":{"milk":{"at_m":[0.1998,0.0995,0.8599],"v_m_per_s":[0.02399,0,1],"w_rad_per_s":[0,0,9999]}},)"
    R"("hands":{"right_hand":{"trigger":0.25,"ahead":[1.0,0.0,0.0],"collision_spheres_m":[[-0.2801,-0.1997,1.07,0.0],[1,2,3,4]]}},"touches":[]})",
};

TEST(ScanFrame, ReadsTheUsualLinesAsTheTablesDo) {
  FrameEntry frame;
  for (const std::string& line : kLines) {
    ASSERT_TRUE(ScanFrame(line, frame)) << line;
    EXPECT_EQ(TextOf(frame), TextOf(FromTables(line).value())) << line;
  }
}

TEST(ScanFrame, LeavesMistakesAndWhatIsRareToTheTables) {
  FrameEntry frame;
  for (const std::string& line : std::initializer_list<std::string>{
           "",
           "{}",
           "[]",
           R"({"tick": 1.5})",
           R"({"tick": 1e3})",
           R"({"tick": 01})",
           R"({"tick": 1} x)",
           R"({"tick": 1, "tick": 2})",
           R"({"tick": 1, "end_tick": 2})",
           R"({"end_tick": 2})",
           R"({"tick": 9999999999999})",
           R"({"tick": 1, "samples": {"cup": {}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 0, 0]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 20000]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 1.]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, .1]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, +1]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, NaN]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, null]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 1e999]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 0]}, "cup": {"at_m": [0, 0, 0]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 0], "at_m": [0, 0, 0]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 0], "quat_wxyz": [1, 1, 0, 0]}}})",
           R"({"tick": 1, "samples": {"cup": {"at_m": [0, 0, 0], "asleep": true}}})",
           R"({"tick": 1, "samples": {"c\u0075p": {"at_m": [0, 0, 0]}}})",
           R"({"tick": 1, "hands": {"hand": {"trigger": 2}}})",
           R"({"tick": 1, "hands": {"hand": {"ahead": [0, 0, 0]}}})",
           R"({"tick": 1, "hands": {"hand": {"collision_spheres_m": []}}})",
           R"({"tick": 1, "hands": {"hand": {"collision_spheres_m": [[0, 0, 0, -1]]}}})",
           R"({"tick": 1, "hands": {"hand": {"style": "hook"}}})",
           R"({"tick": 1, "touches": [{"a": "cup", "b": "table"}]})"}) {
    EXPECT_FALSE(ScanFrame(line, frame)) << line;
  }
}

// Whatever it takes, the tables take, too, and say the same.
TEST(ScanFrame, DamagedLinesAreTakenByBothOrLeft) {
  static constexpr std::string_view kLetters = "{}[]\":,.-+eE019 \t\\xat\n";
  std::mt19937 random(1);
  FrameEntry frame;
  int taken = 0;
  for (int trial = 0; trial < 30'000; ++trial) {
    std::string line = kLines[random() % std::size(kLines)];
    for (auto changes = 1 + random() % 2; changes > 0; --changes) {
      const std::size_t at = random() % line.size();
      const char letter = kLetters[random() % kLetters.size()];
      switch (random() % 3) {
        case 0:
          line[at] = letter;
          break;
        case 1:
          line.insert(at, 1, letter);
          break;
        default:
          line.erase(at, 1);
      }
    }
    if (!ScanFrame(line, frame)) continue;
    ++taken;
    const std::optional<FrameEntry> expected = FromTables(line);
    ASSERT_TRUE(expected) << line;
    ASSERT_EQ(TextOf(frame), TextOf(*expected)) << line;
  }
  EXPECT_GT(taken, 1000);
}

}  // namespace
}  // namespace prehend::episode

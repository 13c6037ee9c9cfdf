// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "harness/scenario/motion/body_motion.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

/// Tests run beside each other: each process has its own.
std::string Folder() {
  const std::string folder = testing::TempDir() + "motion_track_" + std::to_string(getpid()) + "/";
  std::filesystem::create_directories(folder);
  return folder;
}

std::string Write(const std::string& name, const std::string& text) {
  const std::string path = Folder() + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// What is said about a file, its folder left out.
std::string Shown(const grammar::Diagnostics& diagnostics) {
  std::string text = Brief(diagnostics);
  for (std::size_t at; (at = text.find(Folder())) != std::string::npos;)
    text.erase(at, Folder().size());
  return text;
}

std::string CsvErrors(const std::string& text) {
  return Shown(ErrorsOf(ReadMotionCsv(Write("m.csv", text))));
}

TEST(MotionCsvTest, ReadsUnitsOfTheHeader) {
  const auto track =
      ReadMotionCsv(Write("m.csv",
                          "# a comment\n"
                          "t_ms, x_mm, y_cm, z_m, roll_deg, pitch_deg, yaw_rad, trigger\n"
                          "100, 500, 20, 1.5, 0, 0, 1.5707963267948966, 0\n"
                          "\n"
                          "350, 600, 20, 1.5, 0, 0, 0, 1\n"));
  ASSERT_TRUE(track) << Shown(ErrorsOf(track));
  ASSERT_EQ(track->samples.size(), 2u);
  const TrackSample &a = track->samples[0], &b = track->samples[1];
  EXPECT_DOUBLE_EQ(a.t_s, 0);
  EXPECT_NEAR(b.t_s, 0.25, 1e-12);
  EXPECT_LT((a.X_RD.p_m - Eigen::Vector3d(0.5, 0.2, 1.5)).norm(), 1e-12);
  EXPECT_LT((a.X_RD.q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_EQ(a.trigger, 0.0);
  EXPECT_EQ(b.trigger, 1.0);
  EXPECT_EQ(b.place.line, 5);
}

TEST(MotionCsvTest, QuaternionAndTriggerAreOptional) {
  const auto track = ReadMotionCsv(Write("m.csv", "t_s,x_m,y_m,z_m\n0,0,0,1\n1,0,0,1\n"));
  ASSERT_TRUE(track);
  EXPECT_FALSE(track->samples[0].trigger);
  EXPECT_DOUBLE_EQ(track->samples[0].X_RD.q.w(), 1);
}

struct BadCsv {
  const char* name;
  const char* text;
  const char* errors;
};

class MotionCsvRefuses : public testing::TestWithParam<BadCsv> {};

TEST_P(MotionCsvRefuses, WithItsPlace) { EXPECT_EQ(CsvErrors(GetParam().text), GetParam().errors); }

// clang-format off
INSTANTIATE_TEST_SUITE_P(Files, MotionCsvRefuses, testing::Values(
    BadCsv{"unit", "t_s,x_inch,y_m,z_m\n0,0,0,0\n1,0,0,0\n", "m.csv:1:5: 'x_inch' is no column of a motion | the header is like t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger\n"},
    BadCsv{"unit_left_out", "t,x_m,y_m,z_m\n0,0,0,0\n1,0,0,0\n", "m.csv:1:1: 't' is no column of a motion | did you mean 't_s'?\n"},
    BadCsv{"typo", "t_s,x_m,y_m,z_m,triger\n0,0,0,0,0\n1,0,0,0,0\n", "m.csv:1:17: 'triger' is no column of a motion | did you mean 'trigger'?\n"},
    BadCsv{"twice", "t_s,x_m,x_mm,y_m,z_m\n0,0,0,0,0\n", "m.csv:1:9: 'x' is given twice\n"},
    BadCsv{"no_header", "0,0,0,1\n", "m.csv:1:1: '0' is no column of a motion | the header is like t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger\n"
                                     "m.csv:1:3: '0' is no column of a motion | the header is like t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger\n"
                                     "m.csv:1:5: '0' is no column of a motion | the header is like t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger\n"
                                     "m.csv:1:7: '1' is no column of a motion | the header is like t_s,x_m,y_m,z_m,qw,qx,qy,qz,trigger\n"},
    BadCsv{"semicolons", "t_s;x_m;y_m;z_m\n0;0;0;1\n", "m.csv:1:1: 't_s;x_m;y_m;z_m' is no column of a motion | commas separate columns and values\n"},
    BadCsv{"incomplete", "t_s,x_m,y_m\n0,0,0\n", "m.csv:1:1: the header needs t_s (or t_ms), x_m, y_m and z_m (or _cm, _mm); missing: z\n"},
    BadCsv{"half_quaternion", "t_s,x_m,y_m,z_m,qw,qx\n0,0,0,0,1,0\n", "m.csv:1:1: a quaternion needs qw, qx, qy and qz; missing: qy, qz\n"},
    BadCsv{"two_orientations", "t_s,x_m,y_m,z_m,qw,qx,qy,qz,yaw_deg\n0,0,0,0,1,0,0,0,0\n", "m.csv:1:1: an orientation is either qw,qx,qy,qz or roll_deg,pitch_deg,yaw_deg\n"},
    BadCsv{"word", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,0, abc,0\n", "m.csv:3:6: expected a number, found 'abc'\n"},
    BadCsv{"nan", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,nan,0,0\n", "m.csv:3:3: expected a number, found 'nan'\n"},
    BadCsv{"short_row", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,0,0\n", "m.csv:3:5: expected 4 values as in the header, found 3\n"},
    BadCsv{"backwards", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,0,0,0\n0.5,0,0,0\n", "m.csv:4:1: the times must increase from row to row: 0.5 s comes after 1 s\n"},
    BadCsv{"far", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,0,0,1000\n", "m.csv:3:7: z: 1000 m is beyond 100 m | does the unit match the header?\n"},
    BadCsv{"no_unit_quaternion", "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,1,0,0\n1,0,0,0,1,0,0,0\n", "m.csv:2:9: qw, qx, qy, qz: expected a unit quaternion, found one of length 1.414\n"},
    BadCsv{"trigger", "t_s,x_m,y_m,z_m,trigger\n0,0,0,0,0\n1,0,0,0,1.5\n", "m.csv:3:9: trigger: expected a number from 0 to 1, found 1.5\n"},
    BadCsv{"one_row", "t_s,x_m,y_m,z_m\n0,0,0,0\n", "m.csv:2:1: 1 row; a motion has at least 2\n"}),
    [](const auto& test) { return test.param.name; });
// clang-format on

TEST(MotionCsvTest, AMissingFileIsNamed) {
  EXPECT_EQ(Shown(ErrorsOf(ReadMotionCsv(Folder() + "none.csv"))), "none.csv:0:0: no such file\n");
}

constexpr const char* kCapture = R"({"right": {"poses": [
  {"position": {"x": 0.1, "y": 1.2, "z": -0.3}, "rotation": {"x": 0, "y": 90, "z": 0}, "timestamp": 1000},
  {"position": {"x": 0.1, "y": 1.2, "z": -0.3}, "rotation": {"x": 0, "y": 0, "z": 0}, "timestamp": 1100},
  {"position": {"x": 0.1, "y": 1.2, "z": -0.3}, "rotation": {"x": 0, "y": 0, "z": 0}, "timestamp": 1200},
  {"position": {"x": 0.1, "y": 1.2, "z": -0.3}, "rotation": {"x": 0, "y": 0, "z": 0}, "timestamp": 1300}],
 "events": [
  {"name": "buttonchanged", "detail": {"id": 1, "state": {}}, "timestamp": 1050},
  {"name": "buttondown", "detail": {"id": 1}, "timestamp": 1050},
  {"name": "buttondown", "detail": {"id": 2}, "timestamp": 1060},
  {"name": "buttonup", "detail": {"id": 1}, "timestamp": 1250}]}})";

TEST(MotionCaptureTest, TurnsIntoOurAxes) {
  const auto track = ReadMotionCapture(Write("m.json", kCapture), {.name = "right"});
  ASSERT_TRUE(track) << Shown(ErrorsOf(track));
  const physics::Pose& turned = track->samples[0].X_RD;
  EXPECT_LT((turned.p_m - Eigen::Vector3d(0.3, -0.1, 1.2)).norm(), 1e-12);
  // Turned to the left by a right angle: what was ahead is now left.
  EXPECT_LT((turned.q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_LT((turned.q * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
}

TEST(MotionCaptureTest, APressWithoutAValueRisesWithinItsTime) {
  const auto track =
      ReadMotionCapture(Write("m.json", kCapture), {.name = "right", .button = 1, .press_s = 0.1});
  ASSERT_TRUE(track);
  std::vector<double> triggers;
  for (const TrackSample& sample : track->samples) triggers.push_back(*sample.trigger);
  ASSERT_EQ(triggers.size(), 4u);
  EXPECT_DOUBLE_EQ(triggers[0], 0);
  EXPECT_NEAR(triggers[1], 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(triggers[2], 1);
  EXPECT_NEAR(triggers[3], 0.5, 1e-9);
}

TEST(MotionCaptureTest, ValuesGoBeforePresses) {
  std::string text = kCapture;
  text.replace(text.find("\"state\": {}"), 11, "\"state\": {\"value\": 0.25}");
  const auto track = ReadMotionCapture(Write("m.json", text), {.name = "right"});
  ASSERT_TRUE(track);
  EXPECT_DOUBLE_EQ(*track->samples[1].trigger, 0.25);
  EXPECT_DOUBLE_EQ(*track->samples[3].trigger, 0.25);
}

TEST(MotionCaptureTest, Refuses) {
  const auto errors = [](const std::string& text, const std::string& device) {
    return Shown(ErrorsOf(ReadMotionCapture(Write("m.json", text), {.name = device})));
  };
  EXPECT_EQ(errors(kCapture, "rigth"),
            "m.json:1:1: no device is called 'rigth' | did you mean 'right'?\n");
  EXPECT_EQ(errors("[1, 2]", "right"),
            "m.json:1:1: expected an object with the devices of a recording | like {\"right\": "
            "{\"poses\": [...], \"events\": [...]}}\n");
  EXPECT_EQ(errors(R"({"right": {}})", "right"), "m.json:1:2: 'right' has no 'poses'\n");
  std::string text = kCapture;
  text.replace(text.find("\"timestamp\": 1200"), 17, "\"timestamp\": 1100");
  EXPECT_EQ(errors(text, "right"),
            "m.json:4:100: the timestamps must increase from pose to pose: 1100 ms comes after "
            "1100 ms\n");
  EXPECT_EQ(errors("{\"right\": [", "right"),
            "m.json:1:1: not valid JSON: a '[' before this is not closed | each '[' needs its ']', "
            "each '{' its '}'\n");
  const auto with_state = [&](const char* state) {
    std::string changed = kCapture;
    changed.replace(changed.find("\"state\": {}"), 11, state);
    return errors(changed, "right");
  };
  EXPECT_EQ(with_state("\"state\": {\"value\": 7}"),
            "m.json:7:68: value: expected a number from 0 to 1, found '7'\n");
  const auto with_id = [&](const char* id) {
    std::string changed = kCapture;
    changed.replace(changed.find("\"id\": 2"), 7, id);
    return errors(changed, "right");
  };
  EXPECT_EQ(with_id("\"id\": \"x\""),
            "m.json:9:43: id: expected a whole number from 0 to 1000, found the text 'x'\n");
  EXPECT_EQ(with_id("\"no\": 2"), "m.json:9:3: a 'buttondown' needs a 'detail.id'\n");
}

TEST(CheckTrackTest, GapsAndJumpsAreToldAndLimited) {
  std::string csv = "t_s,x_m,y_m,z_m\n";
  for (int i = 0; i < 50; ++i) {
    if (i >= 20 && i < 35) continue;  // a gap of 0.16 s
    csv += std::to_string(i * 0.01) + "," + (i >= 40 ? "0.09" : "0.0") + ",0,1\n";
  }
  const auto track = ReadMotionCsv(Write("m.csv", csv));
  ASSERT_TRUE(track);
  EXPECT_EQ(Shown(CheckTrack(*track, {})),
            "m.csv:22:1: gap: no sample for 0.160 s before this one, at 0.350 s; it is bridged\n"
            "m.csv:27:1: jump: 0.090 m within 0.010 s, at 0.400 s\n");
  for (const auto& diagnostic : CheckTrack(*track, {})) EXPECT_TRUE(diagnostic.is_warning);
  const auto strict = CheckTrack(*track, {.gap_s = 0.1, .jump_m = 0.05});
  EXPECT_EQ(Shown(strict),
            "m.csv:22:1: gap: no sample for 0.160 s before this one, at 0.350 s; at most 0.1 s are "
            "bridged | cut the "
            "recording with from_s and to_s, or raise max_gap_s\n"
            "m.csv:27:1: jump: 0.090 m within 0.010 s, at 0.400 s; at most 0.05 m are followed | "
            "cut the recording with "
            "from_s and to_s, or raise max_jump_m\n");
  for (const auto& diagnostic : strict) EXPECT_FALSE(diagnostic.is_warning);
}

}  // namespace
}  // namespace prehend::scenario

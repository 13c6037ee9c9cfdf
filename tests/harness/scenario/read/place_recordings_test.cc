// SPDX-License-Identifier: Apache-2.0
// Recording steps in a scenario: what becomes of the file, and what is refused.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "harness/scenario/read/read_parts.h"
#include "physics/motion/trajectory.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;

/// A folder with a recording of 2 s: half a metre along x, the grip closes in the second half.
class RecordedInputTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("recorded_input_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::ofstream csv(folder_ / "line.csv");
    csv << "t_s,x_m,y_m,z_m,trigger\n";
    for (int i = 0; i <= 180; ++i) {
      const double t_s = i / 90.0;
      csv << t_s << "," << t_s / 4 << ",0,1.2," << (t_s > 1 ? 1 : 0) << "\n";
    }
  }

  /// The probe, with this step for its reach.
  Result<Scenario> Read(const std::string& step) {
    return ReadScenarioText((folder_ / "probe.yaml").string(),
                            ProbeWith("{reach: milk, style: wrap, over_s: 0.8}", "{" + step + "}"),
                            {}, ProbeLibrary());
  }
  std::string ErrorsAbout(const std::string& step) {
    std::string text = Brief(ErrorsOf(Read(step)));
    const std::string folder = folder_.string() + "/";
    for (std::size_t at; (at = text.find(folder)) != std::string::npos;)
      text.erase(at, folder.size());
    return text;
  }
  std::vector<physics::TimedPose> Poses(const std::string& step) {
    const auto read = Read(step);
    EXPECT_TRUE(read) << Brief(ErrorsOf(read));
    return read ? std::get<physics::PosesStep>(read->script.stages[0].steps[0].action).poses
                : std::vector<physics::TimedPose>{};
  }

  std::filesystem::path folder_;
};

TEST_F(RecordedInputTest, PosesAndTriggerAreTheFiles) {
  const auto poses = Poses("recording: line.csv, join_s: 0.4");
  ASSERT_EQ(poses.size(), 181u);
  EXPECT_DOUBLE_EQ(poses.front().t_s, 0.4);
  EXPECT_NEAR(poses.back().t_s, 2.4, 1e-5);
  EXPECT_LT((poses.back().X_WH.p_m - Vector3d(0.5, 0, 1.2)).norm(), 1e-5);
  EXPECT_EQ(poses.front().trigger, 0.0);
  EXPECT_EQ(poses.back().trigger, 1.0);
}

TEST_F(RecordedInputTest, IsCutTurnedAndShifted) {
  const auto poses = Poses(
      "recording: line.csv, join_s: 0.5, from_s: 0.5, to_s: 1.5, yaw_deg: 90, start_at_m: [0.1, "
      "0.2, 1.0], palm_m: [0, 0, 0.1], palm_rpy_deg: [0, 0, 180]");
  EXPECT_NEAR(static_cast<double>(poses.size()), 91, 1);
  EXPECT_DOUBLE_EQ(poses.front().t_s, 0.5);
  EXPECT_LT((poses.front().X_WH.p_m - Vector3d(0.1, 0.2, 1.0)).norm(), 1e-9);
  EXPECT_LT((poses.back().X_WH.p_m - Vector3d(0.1, 0.45, 1.0)).norm(), 0.005);
  EXPECT_LT((poses.front().X_WH.q * Vector3d::UnitX() + Vector3d::UnitY()).norm(), 1e-9);
}

TEST_F(RecordedInputTest, CutBetweenTwoSamplesItBeginsThere) {
  std::ofstream(folder_ / "slow.csv") << "t_s,x_m,y_m,z_m\n0,0,0,1\n0.2,0.05,0,1\n0.4,0.1,0,1\n";
  for (const char* file : {"line.csv", "slow.csv"}) {
    const auto poses = Poses(std::string("recording: ") + file + ", join_s: 0, from_s: 0.137");
    ASSERT_GE(poses.size(), 3u) << file;
    EXPECT_EQ(poses.front().t_s, 0) << file;
    for (const auto& pose : poses)
      EXPECT_NEAR(pose.X_WH.p_m.x(), (0.137 + pose.t_s) / 4, 1e-5) << file << " " << pose.t_s;
  }
  // In a gap that is not bridged it begins with the next sample.
  std::ofstream(folder_ / "gap.csv") << "t_s,x_m,y_m,z_m\n0,0,0,1\n1,0.1,0,1\n1.1,0.2,0,1\n";
  const auto poses = Poses("recording: gap.csv, join_s: 0, from_s: 0.9");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses.front().X_WH.p_m.x(), 0.1);
}

TEST_F(RecordedInputTest, FollowsTheRecordingWithoutDriftAtAnyRate) {
  for (const int rate_hz : {477, 960}) {
    const auto read = ReadScenarioText(
        (folder_ / "probe.yaml").string(),
        ProbeWith("{reach: milk, style: wrap, over_s: 0.8}", "{recording: line.csv, join_s: 0.5}"),
        {"world.rate_hz=" + std::to_string(rate_hz)}, ProbeLibrary());
    ASSERT_TRUE(read) << Brief(ErrorsOf(read));
    const auto& poses = std::get<physics::PosesStep>(read->script.stages[0].steps[0].action).poses;
    const physics::Trajectory motion = physics::WaypointTrajectory({}, poses);
    // In its last interval the motion comes to rest.
    for (int tick = rate_hz; tick < static_cast<int>(2.48 * rate_hz); ++tick) {
      const double t_s = static_cast<double>(tick) / rate_hz;
      ASSERT_NEAR(motion.At(t_s).X_WH.p_m.x(), (t_s - 0.5) / 4, 1e-5) << tick;
    }
  }
}

TEST_F(RecordedInputTest, Refuses) {
  EXPECT_EQ(ErrorsAbout("recording: lime.csv"),
            "probe.yaml:11:29: recording: 'lime.csv' cannot be used, see below\nlime.csv:0:0: no "
            "such file\n");
  EXPECT_EQ(ErrorsAbout("recording: line.txt"),
            "probe.yaml:11:29: recording: expected a .csv, .json or .bvh file, found 'line.txt'\n");
  EXPECT_EQ(ErrorsAbout("recording: line.json"),
            "probe.yaml:11:29: recording: a .json file needs the key 'device' | add "
            "device: right\n");
  EXPECT_EQ(ErrorsAbout("recording: line.csv, device: right"),
            "probe.yaml:11:47: device: a CSV file has only one device\n");
  EXPECT_EQ(ErrorsAbout("recording: line.csv, button: 1"),
            "probe.yaml:11:47: button: a CSV file has a trigger but no buttons\n");
  EXPECT_EQ(ErrorsAbout("recording: line.csv, from_s: 1.9, to_s: 1.905"),
            "probe.yaml:11:58: between 1.9 and 1.905 s the recording has 1 of at least 2 samples "
            "| the recording lasts 2.000 s\n");
  EXPECT_EQ(
      ErrorsAbout("recording: line.csv, style: warp"),
      "probe.yaml:11:46: style: hand 'human_right' has no style 'warp' | did you mean 'wrap'?\n");
}

TEST_F(RecordedInputTest, OddRecordingsAreUsedWithAWarning) {
  std::ofstream csv(folder_ / "gap.csv");
  csv << "t_s,x_m,y_m,z_m\n0,0,0,1\n0.01,0,0,1\n0.02,0,0,1\n0.22,0,0,1\n";
  csv.close();
  const auto read = Read("recording: gap.csv");
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  ASSERT_EQ(read->warnings.size(), 1u);
  EXPECT_EQ(read->warnings[0].message,
            "gap: no sample for 0.200 s before this one, at 0.220 s; it is bridged");
  EXPECT_TRUE(read->warnings[0].is_warning);
  EXPECT_EQ(ErrorsAbout("recording: gap.csv, max_gap_s: 0.1"),
            "probe.yaml:11:29: recording: 'gap.csv' cannot be used, see below\n"
            "gap.csv:5:1: gap: no sample for 0.200 s before this one, at 0.220 s; at most 0.1 s "
            "are bridged | cut the "
            "recording with from_s and to_s, or raise max_gap_s\n");
  // What is cut off does not matter.
  EXPECT_TRUE(Read("recording: gap.csv, max_gap_s: 0.1, to_s: 0.02"));
}

TEST_F(RecordedInputTest, TheTriggerHasToBeAButtonThatIsPressed) {
  const auto write = [&](const std::string& events) {
    const std::string pose =
        R"({"position": {"x": 0, "y": 1, "z": 0}, "rotation": {"x": 0, "y": 0, "z": 0}, "timestamp": )";
    std::ofstream(folder_ / "pad.json") << R"({"left": {}, "right": {"poses": [)" << pose << "0}, "
                                        << pose << "10}], \"events\": [" << events << "]}}";
  };
  write(R"({"name": "buttondown", "detail": {"id": 2}, "timestamp": 5})");
  EXPECT_EQ(ErrorsAbout("recording: pad.json"),
            "probe.yaml:11:29: recording: a .json file needs the key 'device' | add "
            "device: left or right\n");
  EXPECT_EQ(ErrorsAbout("recording: pad.json, device: right, button: 3"),
            "probe.yaml:11:62: button: button 3 of 'right' is never pressed | the pressed buttons "
            "are 2\n");
  EXPECT_EQ(ErrorsAbout("recording: pad.json, device: right, button: 2"), "");
  const auto odd = Read("recording: pad.json, device: right");
  ASSERT_TRUE(odd && odd->warnings.size() == 1) << Brief(ErrorsOf(odd));
  EXPECT_EQ(odd->warnings[0].message,
            "button 1 of 'right' is never pressed, so the grip stays open");
  write("");
  EXPECT_EQ(ErrorsAbout("recording: pad.json, device: right, button: 2"),
            "probe.yaml:11:62: button: button 2 of 'right' is never pressed | no button is ever "
            "pressed\n");
  EXPECT_TRUE(Read("recording: pad.json, device: right")->warnings.empty());
}

/// A person of sticks whose hips go up by 10 and ahead by 100 from the first frame to the third.
const std::string kSticks =
    "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
    "JOINT Head\n{\nOFFSET 0 60 0\n}\n"
    "JOINT RArm\n{\nOFFSET -20 50 0\nJOINT RForeArm\n{\nOFFSET 0 -30 0\nJOINT RHand\n{\nOFFSET 0 "
    "-25 0\n}\n}\n}\n"
    "JOINT LArm\n{\nOFFSET 20 50 0\nJOINT LForeArm\n{\nOFFSET 0 -30 0\nJOINT LHand\n{\nOFFSET 0 "
    "-25 0\n}\n}\n}\n"
    "JOINT RThigh\n{\nOFFSET -10 0 0\nJOINT RShin\n{\nOFFSET 0 -40 0\nJOINT RFoot\n{\nOFFSET 0 -40 "
    "0\n}\n}\n}\n"
    "JOINT LThigh\n{\nOFFSET 10 0 0\nJOINT LShin\n{\nOFFSET 0 -40 0\nJOINT LFoot\n{\nOFFSET 0 -40 "
    "0\n}\n}\n}\n"
    "}\nMOTION\nFrames: 3\nFrame Time: 0.2\n50 180 7\n50 185 57\n50 190 107\n";

/// A person of 2 m stands at x = -0.9, on a floor at 0.1, and does this step.
class RecordedBodyTest : public RecordedInputTest {
 protected:
  void SetUp() override {
    RecordedInputTest::SetUp();
    std::ofstream(folder_ / "sticks.bvh") << kSticks;
  }
  Result<Scenario> ReadBody(const std::string& step, const std::string& actor = "anna") {
    const std::string text = ProbeWith(
        "script:\n", "  anna: {person: body, at_m: [-0.9, 0, 0.1], height_m: 2}\nscript:\n  - " +
                         actor + ": {" + step + "}\n");
    return ReadScenarioText((folder_ / "probe.yaml").string(), text, {}, ProbeLibrary());
  }
  std::string Refused(const std::string& step, const std::string& actor = "anna") {
    std::string text = Brief(ErrorsOf(ReadBody(step, actor)));
    const std::string folder = folder_.string() + "/";
    for (std::size_t at; (at = text.find(folder)) != std::string::npos;)
      text.erase(at, folder.size());
    return text;
  }
  std::vector<physics::TimedPosture> Postures(const std::string& step) {
    const auto read = ReadBody(step);
    EXPECT_TRUE(read) << Brief(ErrorsOf(read));
    if (!read) return {};
    return std::get<physics::BodyPosesStep>(read->script.stages[0].person_steps[0].action).postures;
  }
};

TEST_F(RecordedBodyTest, IsScaledToHerLegsAndStandsOnHerFloor) {
  const auto postures = Postures("recording: sticks.bvh, join_s: 0.3, max_jump_m: 9");
  ASSERT_EQ(postures.size(), 3u);
  EXPECT_NEAR(postures[1].t_s, 0.5, 1e-12);
  // Her legs are 0.491 of 2 m, the file's 80: so 50 is 0.6138 m; x of the file is our y.
  EXPECT_NEAR(postures[0].posture.hips_W_m.y(), 50 * 0.982 / 80, 1e-9);
  // Hips over the ankles, and those as high over the floor as when she stands.
  EXPECT_NEAR(postures[0].posture.hips_W_m.z(), 0.1 + 0.039 * 2 + 0.982, 1e-9);
  EXPECT_NEAR(postures[2].posture.hips_W_m.x() - postures[0].posture.hips_W_m.x(), 100 * 0.982 / 80,
              1e-9);
}

TEST_F(RecordedBodyTest, ScalePlaceAndYawAreTheScenarios) {
  const auto postures = Postures(
      "recording: sticks.bvh, scale: 0.01, start_at_m: [1, 2, 0.5], yaw_deg: 90, join_s: 0, "
      "max_jump_m: 9");
  ASSERT_EQ(postures.size(), 3u);
  EXPECT_NEAR(postures[0].posture.hips_W_m.x(), 1, 1e-9);
  EXPECT_NEAR(postures[2].posture.hips_W_m.y(), 3, 1e-9);
  EXPECT_NEAR(postures[0].posture.hips_W_m.z(), 0.5 + 0.078 + 0.8, 1e-9);
  EXPECT_LT((postures[0].posture.directions_W[physics::Posture::kFace] - Vector3d::UnitY()).norm(),
            1e-9);
}

TEST_F(RecordedBodyTest, Refuses) {
  EXPECT_EQ(
      Refused("recording: sticks.bvh", "right_hand"),
      "probe.yaml:12:29: recording: a BVH file moves a whole body, not a hand | give this step "
      "to a person; hands "
      "follow .csv and .json files\n");
  EXPECT_NE(Refused("recording: sticks.bvh, palm_m: [0, 0, 0]")
                .find("palm_m: a BVH file moves a whole body, not a hand"),
            std::string::npos);
  EXPECT_NE(
      Refused("recording: line.csv, scale: 1").find("scale: only a BVH file has units of its own"),
      std::string::npos);
  EXPECT_NE(Refused("recording: sticks.bvh, max_gap_s: 0.1")
                .find("gap: frames are 0.200 s apart; at most 0.1 s are bridged | raise max_gap_s"),
            std::string::npos);
  EXPECT_NE(Refused("recording: sticks.bvh, scale: 0.035")
                .find("hips: jump: 1.759 m within 0.200 s, at 0.200 s; at most 0.1 m"),
            std::string::npos);
  EXPECT_NE(Refused("recording: sticks.bvh, scale: 1")
                .find("scale: the recorded legs would be 80 m long, hers are 0.982 m | try 0.0123 "
                      "metres per unit; without scale the motion is scaled to her legs"),
            std::string::npos);
  EXPECT_NE(Refused("recording: sticks.bvh, start_at_m: [19.5, 0, 0], max_jump_m: 9")
                .find("the hips are more than 20 m from the origin here"),
            std::string::npos);
}

}  // namespace
}  // namespace prehend::scenario

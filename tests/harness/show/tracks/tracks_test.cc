// SPDX-License-Identifier: Apache-2.0
// Conditions and signals over time, on frames written by hand.
#include "harness/show/tracks/tracks.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/harness/show/explain/explain_stage.h"

namespace prehend::show::testing {
namespace {

constexpr const char* kGrammar =
    "condition met(h: Hand, c: Cup) while touching(h, c)\n"
    "event pushed(h: Hand, c: Cup) while met(h, c) requires displacement(c) > 10 cm and height(c) "
    "< 1 m";

grammar::ReplayMonitor& Push(Stage& stage) {
  stage.Show(2);
  stage.Touch(true);
  stage.Show(1);
  stage.CupAt(0.25);
  stage.Show(1);
  stage.Touch(false);
  stage.Show(1);
  return stage.Finish();
}

TEST(Tracks, AColumnPerConditionAndSignalARowPerFrame) {
  Stage stage(kGrammar);
  std::ostringstream csv;
  WriteCsv(CollectTracks(Push(stage), {}), csv);
  EXPECT_EQ(csv.str(),
            "time_s,tick,\"touching(cup, hand)\",\"met(hand, cup)\",\"pushed(hand, "
            "cup)\",pushed: displacement(cup) [m],"
            "height(cup) [m]\n"
            "0.0000,0,0,0,0,,0\n"
            "0.0100,10,0,0,0,,0\n"
            "0.0200,20,1,1,1,0,0\n"
            "0.0300,30,1,1,1,0.25,0\n"
            "0.0400,40,0,0,0,0.25,0\n");
}

TEST(Tracks, SomeOfThemByName) {
  Stage stage(kGrammar);
  grammar::ReplayMonitor& past = Push(stage);
  EXPECT_EQ(TrackNames(past.program()),
            (std::vector<std::string>{"displacement", "height", "met", "pushed", "robustness",
                                      "touching"}));
  std::ostringstream csv;
  WriteCsv(CollectTracks(past, {"height", "met"}), csv);
  EXPECT_EQ(csv.str().substr(0, csv.str().find('\n')),
            "time_s,tick,\"met(hand, cup)\",height(cup) [m]");
}

TEST(Tracks, JsonSaysWhatEachIs) {
  Stage stage(kGrammar);
  grammar::ReplayMonitor& past = Push(stage);
  std::ostringstream out;
  WriteJson(CollectTracks(past, {}), "episode", "test", out);
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json["tick"], nlohmann::json({0, 10, 20, 30, 40}));
  EXPECT_EQ(json["tracks"][1]["kind"], "condition");
  EXPECT_EQ(json["tracks"][2]["kind"], "event");
  EXPECT_EQ(json["tracks"][3]["unit"], "m");
  EXPECT_TRUE(json["tracks"][3]["values"][0].is_null());
  EXPECT_EQ(json["tracks"][3]["values"][3], 0.25);
}

TEST(Tracks, ARegionIsADistance) {
  Stage stage(
      "event near(c: Cup, t: Movable) while in_cylinder(position(c), position(t), 10 cm, 5 cm)");
  stage.CupAt(0.07);
  stage.scene.looks[grammar::testing::Scene::kCup].p_WB_m.z() = 0.125;
  stage.Show();
  const Tracks tracks = CollectTracks(stage.Finish(), {});
  const auto find = [&](const std::string& name) {
    for (const Track& track : tracks.tracks) {
      if (track.name == name) return track.values[0];
    }
    return std::optional<double>();
  };
  const std::string region = "in_cylinder(position(cup), position(tray), 0.1 m, 0.05 m)";
  EXPECT_EQ(find(region + ": from the centre"), 0.07);
  EXPECT_EQ(find(region + ": above or below the centre"), 0.125);
}

}  // namespace
}  // namespace prehend::show::testing

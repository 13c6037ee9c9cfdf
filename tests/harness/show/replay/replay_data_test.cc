// SPDX-License-Identifier: Apache-2.0
// The data of a replay say where everything is.
#include "harness/show/replay/replay_data.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace prehend::show {
namespace {

/// A cup that rises by 1 mm per tick, beside a board, a camera and a region.
struct Rising {
  Rising() {
    using enum physics::Abstract;
    Add({.name = "cup", .shapes = {{physics::Cylinder{0.04, 0.1}, {}}}});
    Add({.name = "board", .shapes = {{physics::Box{{1, 1, 0.02}}, {}}}, .fixed = true});
    Add({.name = "eye", .shapes = {{physics::Sphere{0.1}, {}}}, .abstract = kCamera});
    Add({.name = "goal", .shapes = {{physics::Sphere{0.1}, {}}}, .abstract = kRegion});
    run.timeline.ticks_per_second = 480;
    for (int i = 0; i <= 100; ++i) {
      physics::Snapshot frame;
      frame.tick = i;
      frame.bodies.resize(scenario.scene.bodies.size());
      frame.bodies[0].X_WB.p_m = {0.25, -0.5, 0.001 * i};
      physics::ContactPoint touch;
      touch.p_W_m = {0.25, -0.5, 0.123};
      frame.contacts.push_back(touch);
      run.recording.push_back(frame);
    }
  }
  void Add(physics::Body body) {
    scenario.scene.bodies.push_back(std::move(body));
    scenario.body_classes.emplace_back("Thing");
  }
  scenario::Scenario scenario;
  episode::RunResult run;
};

TEST(ReplayData, SaysWhereThingsAre) {
  const Rising rising;
  const nlohmann::json data = ReplayJson(rising.scenario, rising.run);
  EXPECT_EQ(data.at("ticks_per_second"), 480);
  EXPECT_EQ(data.at("end"), 100);
  ASSERT_EQ(data.at("bodies").size(), 3u) << "a camera is not seen";
  const auto& cup = data.at("bodies")[0];
  EXPECT_EQ(cup.at("kind"), "thing");
  EXPECT_EQ(cup.at("shapes")[0].at("kind"), "cylinder");
  EXPECT_EQ(cup.at("track").at("t"), (nlohmann::json{0, 100}));
  EXPECT_EQ(cup.at("track").at("p"), (nlohmann::json{2500, -5000, 0, 0, 0, 1000}));
  EXPECT_EQ(data.at("bodies")[1].at("kind"), "fixed");
  EXPECT_EQ(data.at("bodies")[1].at("track").at("t").size(), 1u);
  EXPECT_EQ(data.at("bodies")[2].at("kind"), "region");
  EXPECT_EQ(data.at("contacts").at("every"), 16);
  EXPECT_EQ(data.at("contacts").at("samples").size(), 7u);
  EXPECT_EQ(data.at("contacts").at("samples")[0], (nlohmann::json{250, -500, 123}));
}

TEST(ReplayData, IsDeflatedInBase64) {
  const Rising rising;
  const std::string text = ReplayData(rising.scenario, rising.run);
  EXPECT_TRUE(text.starts_with("eF")) << "the first bytes of zlib's quick compression, 78 5e";
  EXPECT_LT(text.size(), 1200u);
  EXPECT_EQ(ReplayData(rising.scenario, {}), "");
}

}  // namespace
}  // namespace prehend::show

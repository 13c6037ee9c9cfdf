// SPDX-License-Identifier: Apache-2.0
// The facts beside a difference are those of its participants, around its moment.
#include <gtest/gtest.h>

#include "harness/suite/judge/judges.h"

namespace prehend::suite {
namespace {

/// A cup rests on a table for ten frames, is in the air for ten, and rests again; a mug touches
/// nobody.
struct Stage {
  scenario::Scenario scenario;
  std::vector<physics::Snapshot> recording;

  Stage() {
    for (const char* name : {"table", "cup", "mug"}) {
      physics::Body body;
      body.name = name;
      body.fixed = body.name == "table";
      scenario.scene.bodies.push_back(body);
      scenario.body_classes.push_back("Object");
      scenario.body_part_of.push_back(grammar::kNoEntity);
    }
    scenario.sensing.sensing_hz = 480;
    scenario.scene.world.rate_hz = 480;
    for (int tick = 0; tick < 30; ++tick) {
      physics::Snapshot snapshot;
      snapshot.tick = tick;
      snapshot.bodies.resize(3);
      snapshot.bodies[1].X_WB.p_m = {0.1, 0.2, 0.3};
      snapshot.bodies[1].v_WB_m_per_s = {0, 0, 0.25};
      const bool in_the_air = tick >= 10 && tick < 20;
      if (!in_the_air) {
        physics::ContactPoint point;
        point.a.body = physics::BodyIndex(0);
        point.b.body = physics::BodyIndex(1);
        point.normal_impulse_n_s = 0.01;
        snapshot.contacts.push_back(point);
      }
      recording.push_back(snapshot);
    }
  }
};

TEST(DifferenceContext, TellsStateAndTouchesOfTheParticipants) {
  const Stage stage;
  const grammar::NamedEvent event{.event = "supported_by",
                                  .roles = {{"object", "cup"}, {"support", "table"}},
                                  .interval = {10, 20}};
  EXPECT_EQ(DifferenceContext(stage.scenario, stage.recording, {.expected = event, .actual = {}}),
            "  facts at 0.0208 s (tick 10):\n"
            "    table at (0.000, 0.000, 0.000) m, 0.000 m/s, rising 0.000 m/s\n"
            "    cup at (0.100, 0.200, 0.300) m, 0.250 m/s, rising 0.250 m/s\n"
            "    table touches cup 0.0000..0.0208 s\n"
            "    table touches cup 0.0417..0.0625 s\n");
}

TEST(DifferenceContext, WhoWasRecognisedInsteadIsToldOf) {
  const Stage stage;
  const grammar::NamedEvent cup{
      .event = "seen", .roles = {{"object", "cup"}}, .interval = {10, 20}};
  const grammar::NamedEvent mug{
      .event = "seen", .roles = {{"object", "mug"}}, .interval = {10, 20}};
  const std::string facts = DifferenceContext(stage.scenario, stage.recording,
                                              {.agreement = truth::LineVerdict::kChanged,
                                               .expected = cup,
                                               .actual = mug,
                                               .changes = {"object: cup -> mug"}});
  EXPECT_NE(facts.find("    cup at "), std::string::npos) << facts;
  EXPECT_NE(facts.find("    mug at "), std::string::npos) << facts;
}

TEST(DifferenceContext, ThereAreNoneWithoutARecording) {
  EXPECT_EQ(DifferenceContext(Stage().scenario, {}, {.expected = {}, .actual = {}}), "");
}

}  // namespace
}  // namespace prehend::suite

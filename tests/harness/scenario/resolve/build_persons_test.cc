// SPDX-License-Identifier: Apache-2.0
// Persons and trackers in a scenario: what is built from them, and what is refused.
#include <gtest/gtest.h>

#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/resolve/resolve.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

const char* const kHands = "  right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}\n";

/// The probe with this actor beside its hand, and these steps as first stage.
std::string WithActor(const std::string& actor, const std::string& stage = "") {
  std::string text = ProbeWith(kHands, kHands + ("  anna: " + actor + "\n"));
  if (!stage.empty()) {
    const std::string script = "script:\n";
    text.insert(text.find(script) + script.size(), "  - " + stage + "\n");
  }
  return text;
}

Result<Scenario> ReadPersons(const std::string& text) {
  return ReadScenarioText("probe.yaml", text, {}, ProbeLibrary());
}
std::string ErrorsAbout(const std::string& text) { return Brief(ErrorsOf(ReadPersons(text))); }

TEST(PersonsTest, ABodyIsAnEntityWithParts) {
  const auto read =
      ReadPersons(WithActor("{person: body, at_m: [-0.9, 0, 0], right_hand: right_hand}"));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const Scenario& scenario = *read;
  ASSERT_EQ(scenario.scene.persons.size(), 1u);
  EXPECT_EQ(scenario.scene.persons[0].head, physics::BodyIndex(2));
  EXPECT_EQ(scenario.scene.persons[0].right_hand, physics::HandIndex(0));
  EXPECT_EQ(scenario.scene.bodies.size(), 2u + 18u);
  const grammar::EntityTable entity_table = episode::MakeEntityTable(scenario);
  EXPECT_EQ(entity_table.entities[2].name, "anna");
  EXPECT_EQ(entity_table.entities[2].classes, (std::vector<std::string>{"Person", "Entity"}));
  EXPECT_EQ(entity_table.entities[3].name, "anna_neck");
  EXPECT_EQ(entity_table.entities[3].classes,
            (std::vector<std::string>{"Neck", "BodyPart", "Entity"}));
  EXPECT_EQ(entity_table.entities[3].part_of, 2);
  EXPECT_EQ(entity_table.entities.back().name, "right_hand");
}

TEST(PersonsTest, HerHandIsAPartOfHer) {
  const auto part_of = [](const std::string& actor) {
    const auto read = Read(WithActor(actor));
    EXPECT_TRUE(read) << Brief(ErrorsOf(read));
    const grammar::EntityTable table = episode::MakeEntityTable(*read);
    EXPECT_EQ(table.entities.back().name, "right_hand");
    const int whole = table.entities.back().part_of;
    return whole == grammar::kNoEntity ? "" : table.entities[static_cast<std::size_t>(whole)].name;
  };
  EXPECT_EQ(part_of("{person: body, at_m: [-0.9, 0, 0], right_hand: right_hand}"), "anna");
  EXPECT_EQ(part_of("{person: body, at_m: [-0.9, 0, 0]}"), "");
}

TEST(PersonsTest, StepsAreUnderstood) {
  const auto read =
      ReadPersons(WithActor("{person: body, at_m: [-0.9, 0, 0]}",
                            "anna: {look_at: milk}\n  - anna: {look_at_m: [1, 0, 1]}\n  - "
                            "anna: {eyes: lead}\n  - anna: {walk_to_m: [-0.8, 0]}\n"
                            "  - anna: {turn_to_deg: 90}\n  - anna: {lean_deg: 20}\n  - "
                            "anna: {move_limb: left_foot, to_m: [-0.5, 0.1, 0.3]}\n"
                            "  - anna: {move_limb: left_foot, max_force_n: 30}\n  - anna: "
                            "{sway_by_m: [0.1, -0.2]}\n  - anna: {wait_s: 0.1}"));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  EXPECT_EQ(read->script.stages[0].person_steps.size(), 1u);
  EXPECT_TRUE(read->script.stages[0].steps.empty());
}

TEST(PersonsTest, WayPointsMayBeRelativeToHerHeadAndToHerParts) {
  const auto errors = [](const std::string& where) {
    return ErrorsAbout(WithActor(
        "{person: body, at_m: [-0.9, 0, 0]}",
        "right_hand: {poses: [{t_s: 1, at_m: [0.1, 0, 0]}], relative_to: " + where + "}"));
  };
  EXPECT_EQ(errors("anna"), "");
  EXPECT_EQ(errors("anna_chest"), "");
  EXPECT_NE(errors("anna_cheast").find("did you mean 'anna_chest'?"), std::string::npos);
}

struct Bad {
  const char* name;
  const char* actor;
  const char* stage;
  const char* errors;
};
class PersonsRefused : public testing::TestWithParam<Bad> {};
TEST_P(PersonsRefused, WithTheirPlace) {
  EXPECT_EQ(ErrorsAbout(WithActor(GetParam().actor, GetParam().stage)), GetParam().errors);
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Files, PersonsRefused, testing::Values(
    Bad{"neither", "{at_m: [-0.9, 0, 0]}", "", "10:10: an actor needs one of the keys hand, person\n"},
    Bad{"both", "{hand: human_left, person: head, at_m: [-0.9, 0, 0]}", "", "10:28: an actor has one of 'hand' and 'person', not both\n"},
    Bad{"kind", "{person: legs, at_m: [-0.9, 0, 0]}", "", "10:18: person: expected one of head, body, found 'legs'\n"},
    Bad{"hand", "{person: head, at_m: [-0.9, 0, 0], right_hand: left_hand}", "", "10:56: right_hand: no hand is called 'left_hand' | known: right_hand\n"},
    Bad{"one_hand_twice", "{person: head, at_m: [-0.9, 0, 0], right_hand: right_hand, left_hand: right_hand}", "", "10:79: left_hand: 'right_hand' is already on another arm\n"},
    Bad{"in_the_milk", "{person: body, at_m: [0.15, 0.1, 0]}", "", "10:30: 'anna_abdomen' starts inside 'milk', 48 mm deep | move the person\n10:30: 'anna_pelvis' starts inside 'milk', 108 mm deep | move the person\n10:30: 'anna_right_thigh' starts inside 'milk', 25 mm deep | move the person\n10:30: 'anna_left_thigh' starts inside 'milk', 25 mm deep | move the person\n"},
    Bad{"hand_step", "{person: head, at_m: [-0.9, 0, 0]}", "anna: {close_to: 1}", "12:5: 'anna' is a person; this step is for hands | persons look, walk, turn, lean, move a limb; their hands are actors of their own\n"},
    Bad{"person_step", "{person: head, at_m: [-0.9, 0, 0]}", "right_hand: {lean_deg: 10}", "12:5: 'right_hand' is a hand; this step is for persons | hands reach, close, move; persons look, walk, lean\n"},
    Bad{"reach_for_her", "{person: head, at_m: [-0.9, 0, 0]}", "right_hand: {reach: anna, style: wrap}", "12:25: reach: 'anna' is a person, not a thing | name one of the 'entities'\n"},
    Bad{"place_on_her", "{person: body, at_m: [-0.9, 0, 0]}", "right_hand: {place_on: anna_chest}", "12:17: place_on: right_hand cannot hold anything here | no step before this one reaches for something or closes the hand\n12:28: place_on: 'anna_chest' is a part of 'anna', not a thing | name one of the 'entities'\n"},
    Bad{"press_a_hand", "{person: head, at_m: [-0.9, 0, 0]}", "right_hand: {press_n: 5, against: right_hand}", "12:39: press_n: 'right_hand' is a hand, not a thing | name one of the 'entities'\n"},
    Bad{"nobody", "{person: head, at_m: [-0.9, 0, 0]}", "bert: {look_at: mlik}", "12:5: no actor is called 'bert' | known: right_hand, anna\n"},
    Bad{"look_at_herself", "{person: body, at_m: [-0.9, 0, 0]}", "anna: {look_at: anna_left_foot}",
        "12:21: look_at: 'anna' cannot look at herself | name a thing, a hand or another person, or give a point with look_at_m\n"},
    Bad{"look_at", "{person: head, at_m: [-0.9, 0, 0]}", "anna: {look_at: mlik}", "12:21: look_at: no entity is called 'mlik' | did you mean 'milk'?\n"},
    Bad{"no_limbs", "{person: head, at_m: [-0.9, 0, 0]}", "anna: {move_limb: right_foot}", "12:23: move_limb: 'anna' is only a head | write 'person: body'\n"},
    Bad{"no_hips", "{person: head, at_m: [-0.9, 0, 0]}", "anna: {sway_by_m: [0, 0.1]}", "12:23: sway_by_m: 'anna' is only a head | write 'person: body'\n"},
    Bad{"sway_too_far", "{person: body, at_m: [-0.9, 0, 0]}", "anna: {sway_by_m: [0, 0.5]}", "12:27: sway_by_m[1]: expected a number from -0.4 to 0.4, found '0.5'\n"},
    Bad{"weak", "{person: body, at_m: [-0.9, 0, 0]}", "anna: {move_limb: right_foot, max_force_n: 0}", "12:48: max_force_n: expected a number from 1 to 10000, found '0'\n"},
    Bad{"limb", "{person: body, at_m: [-0.9, 0, 0]}", "anna: {move_limb: right_foo}", "12:23: move_limb: expected one of right_elbow, left_elbow, right_wrist, left_wrist, right_foot, left_foot, found 'right_foo' | did you mean 'right_foot'?\n"},
    Bad{"arm_of_a_hand", "{person: body, at_m: [-0.9, 0, 0], right_hand: right_hand}", "anna: {move_limb: right_elbow, to_m: [0, 0, 1]}", "12:23: move_limb: this arm follows the hand 'right_hand' | move the hand instead\n"}),
    [](const auto& test) { return test.param.name; });
// clang-format on

TEST(PersonsTest, NamesOfPartsMustBeFree) {
  const std::string text = WithActor("{person: body, at_m: [-0.9, 0, 0]}");
  const std::string taken =
      "entities:\n  anna_pelvis: {fixed: true, sphere: {radius_m: 0.1}, at_m: [0, 3, 1]}\n";
  std::string clash = text;
  clash.replace(clash.find("entities:\n"), 10, taken);
  EXPECT_EQ(ErrorsAbout(clash),
            "11:3: 'anna_pelvis' names both a part of 'anna' and something else\n");
}

std::string WithTracking(const std::string& tracking) {
  return ProbeWith("at_m: [-0.2, -0.2, 1.05]}",
                   "at_m: [-0.2, -0.2, 1.05], tracking: " + tracking + "}");
}

TEST(TrackingOfAHandTest, IsReadWithItsDefaults) {
  const auto read =
      ReadPersons(WithTracking("{jitter_mm: 1.5, dropped_share: 0.2, dropped_run_s: 0.1}"));
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const auto& tracking = read->scene.hands[0].tracking;
  ASSERT_TRUE(tracking);
  EXPECT_EQ(tracking->tracker_hz, 90);
  EXPECT_EQ(tracking->jitter_mm, 1.5);
  EXPECT_EQ(tracking->dropped_run_s, 0.1);
  EXPECT_FALSE(ReadPersons(kProbe)->scene.hands[0].tracking);
}

TEST(TrackingOfAHandTest, IsSetFromTheCommandLine) {
  const auto read = ReadScenarioText("probe.yaml", kProbe,
                                     {"actors.right_hand.tracking.latency_s=0.1"}, ProbeLibrary());
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  EXPECT_EQ(read->scene.hands[0].tracking->latency_s, 0.1);
}

TEST(TrackingOfAHandTest, Refuses) {
  EXPECT_EQ(ErrorsAbout(WithTracking("{jitter_m: 1}")),
            "9:72: unknown key 'jitter_m' in the tracking | did you mean 'jitter_mm'?\n");
  EXPECT_EQ(ErrorsAbout(WithTracking("{tracker_hz: 960}")),
            "9:71: tracker_hz 960 is above rate_hz 480\n");
  EXPECT_EQ(ErrorsAbout(WithTracking("{latency_s: 3}")),
            "9:83: latency_s: expected a number from 0 to 2, found '3'\n");
  EXPECT_EQ(ErrorsAbout(WithTracking("{tracker_hz: 10, dropped_share: 0.9, dropped_run_s: 0.5}")),
            "9:123: dropped_run_s: a share of 0.9 needs losses of at least 0.900 s\n");
}

}  // namespace
}  // namespace prehend::scenario

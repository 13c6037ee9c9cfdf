// SPDX-License-Identifier: Apache-2.0
// Put-downs that cannot end well are refused with their full text; whatever the script does not
// say is not judged.
#include <gtest/gtest.h>

#include "harness/scenario/resolve/resolve.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

constexpr const char* kThings = R"(scenario: probe
shows: a carton is put down
entities:
  table: {fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  shelf: {fixed: true, box: {size_m: [0.3, 0.3, 0.02]}, at_m: [-0.3, 0, 1.0]}
  milk: {box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4, on: table, at_m: [0.2, 0.1]}
  cup: {cylinder: {radius_m: 0.04, length_m: 0.1}, mass_kg: 0.2, on: table, at_m: [0.2, -0.2]}
  tray: {tray: {size_m: [0.2, 0.2, 0.04]}, mass_kg: 0.5, on: table, at_m: [0.4, 0.25]}
  drawer: {box: {size_m: [0.1, 0.1, 0.05]}, mass_kg: 0.5, at_m: [0, 0.3, 1.3], slider: {to: table, axis: [1, 0, 0], range_m: [0, 0.2]}}
actors:
  right_hand: {hand: human_right, at_m: [-0.2, -0.3, 1.35]}
  left_hand: {hand: human_left, at_m: [-0.2, 0.3, 1.55]}
script:
  - right_hand: {reach: milk}
  - right_hand: {close_to: 1}
)";

/// The complaints about these further steps, which begin in line 16.
std::string After(const std::string& steps) {
  return Brief(
      ErrorsOf(ReadScenarioText("probe.yaml", std::string(kThings) + steps, {}, ProbeLibrary())));
}

TEST(ValidatePutDowns, AFreePlaceOnTheSupportIsFine) {
  EXPECT_EQ(After(R"(  - right_hand: {lift_by_m: 0.2}
  - right_hand: {carry_to_m: [0, -0.2]}
  - right_hand: {place_on: table}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)"),
            "");
  EXPECT_EQ(After("  - right_hand: {lift_by_m: 0.1}\n  - right_hand: {place_on: table}\n"), "");
  EXPECT_EQ(After(R"(  - right_hand: {lift_by_m: 0.5}
  - right_hand: {carry_to_m: [-0.3, 0]}
  - right_hand: {place_on: shelf}
)"),
            "");
}

TEST(ValidatePutDowns, NoPartOfTheSupportIsBelow) {
  EXPECT_EQ(
      After("  - right_hand: {lift_by_m: 0.5}\n  - right_hand: {place_on: shelf}\n"),
      "17:28: place_on: no part of 'shelf' is below 'milk' | by the steps before, 'milk' is at "
      "[0.20, 0.10, 1.36]; carry it there first\n");
  // Beside the table; and above the shelf's place, but below the shelf.
  EXPECT_EQ(
      After("  - right_hand: {move_by_m: [0.5, 0, 0.3]}\n  - right_hand: {place_on: table}\n"),
      "17:28: place_on: no part of 'table' is below 'milk' | by the steps before, 'milk' is at "
      "[0.70, 0.10, 1.16]; carry it there first\n");
  EXPECT_EQ(
      After("  - right_hand: {carry_to_m: [-0.3, 0]}\n  - right_hand: {place_on: shelf}\n"),
      "17:28: place_on: no part of 'shelf' is below 'milk' | by the steps before, 'milk' is at "
      "[-0.30, 0.00, 0.86]; carry it there first\n");
}

TEST(ValidatePutDowns, TheCentreIsAboveTheSupport) {
  const auto carried_to = [](const char* y) {
    return "  - right_hand: {lift_by_m: 0.2}\n  - right_hand: {carry_to_m: [0.2, " +
           std::string(y) + "]}\n  - right_hand: {place_on: table}\n";
  };
  EXPECT_EQ(
      After(carried_to("-0.43")),
      "18:28: place_on: the centre of 'milk' is not above 'table': it would tip over | by the "
      "steps before, 'milk' is at [0.20, -0.43, 1.06]; carry its centre over it\n");
  // A carton on the edge stands or falls with a few millimetres of the grasp.
  EXPECT_EQ(After(carried_to("-0.405")), "");
}

TEST(ValidatePutDowns, ThePlaceIsFree) {
  const std::string onto_the_cup = R"(  - right_hand: {lift_by_m: 0.3}
  - right_hand: {carry_to_m: [0.2, -0.17]}
  - right_hand: {place_on: table}
)";
  EXPECT_EQ(After(onto_the_cup),
            "18:28: place_on: 'cup' is in the way: 'milk' would overlap it by 45 mm | by the steps "
            "before, 'milk' is at [0.20, -0.17, 1.16]; carry it to a free place\n");
  // A centimetre is what fingers may shift a thing by.
  EXPECT_EQ(After(R"(  - right_hand: {lift_by_m: 0.3}
  - right_hand: {carry_to_m: [0.2, -0.133]}
  - right_hand: {place_on: table}
)"),
            "");
  // What was put down before is in the way where it stands now.
  EXPECT_EQ(After(R"(  - right_hand: {lift_by_m: 0.2}
  - right_hand: {carry_to_m: [-0.1, -0.1]}
  - right_hand: {place_on: table}
  - right_hand: {open_to: 0}
  - right_hand: {reach: cup}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.3}
  - right_hand: {carry_to_m: [-0.1, -0.1]}
  - right_hand: {place_on: table}
)"),
            "24:28: place_on: 'milk' is in the way: 'cup' would overlap it by 75 mm | by the steps "
            "before, 'cup' is at [-0.10, -0.10, 1.11]; carry it to a free place\n");
}

TEST(ValidatePutDowns, WhatTheScriptDoesNotSayIsNotJudged) {
  const std::string aside = "  - right_hand: {move_by_m: [0.5, 0, 0.3]}\n";
  const std::string place = "  - right_hand: {place_on: table}\n";
  ASSERT_NE(After(aside + place), "");
  for (const char* unknown :
       {"  - right_hand: {poses: [{t_s: 1, at_m: [0.1, 0, 1.2]}]}\n",    // anywhere
        "  - right_hand: {retreat_by_m: 0.1}\n",                         // the way it came
        "  - left_hand: {reach: milk}\n  - left_hand: {close_to: 1}\n",  // two hands pull
        "  - left_hand: {move_by_m: [0.1, 0, 0]}\n"})                    // an open hand pushes
    EXPECT_EQ(After(unknown + aside + place), "") << unknown;
  // Dropped in the air and taken again, on a joint, beside what was carried away.
  EXPECT_EQ(After(aside + "  - right_hand: {open_to: 0}\n  - right_hand: {close_to: 1}\n" + place),
            "");
  EXPECT_EQ(After("  - left_hand: {reach: drawer}\n  - left_hand: {close_to: 1}\n"
                  "  - left_hand: {follow_joint: drawer}\n" +
                  aside + place),
            "");
  EXPECT_EQ(After(R"(  - left_hand: {reach: cup}
  - left_hand: {close_to: 1}
  - left_hand: {retreat_by_m: 0.3}
    right_hand: {lift_by_m: 0.3}
  - right_hand: {carry_to_m: [0.2, -0.2]}
  - right_hand: {place_on: table}
)"),
            "");
}

TEST(ValidatePutDowns, WhatStandsOnACarriedThingComesAlong) {
  EXPECT_EQ(After(R"(  - right_hand: {lift_by_m: 0.2}
  - right_hand: {carry_to_m: [0.4, 0.25]}
  - right_hand: {place_on: tray}
  - right_hand: {open_to: 0}
  - left_hand: {reach: tray}
  - left_hand: {close_to: 1}
  - left_hand: {carry_to_m: [-0.1, 0.25]}
  - right_hand: {reach: cup}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.3}
  - right_hand: {carry_to_m: [0.4, 0.25]}
  - right_hand: {place_on: table}
)"),
            "");
}

}  // namespace
}  // namespace prehend::scenario

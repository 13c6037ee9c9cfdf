// SPDX-License-Identifier: Apache-2.0
// Masses and sizes that look like a mistaken unit are warned of, with numbers.
#include <gtest/gtest.h>

#include "harness/scenario/resolve/resolve.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

std::string Warned(const std::string& from, const std::string& to) {
  const auto read = ReadScenarioText("probe.yaml", ProbeWith(from, to), {}, ProbeLibrary());
  EXPECT_TRUE(read) << Format(ErrorsOf(read));
  if (!read) return "";
  for (const grammar::Diagnostic& warning : read->warnings) EXPECT_TRUE(warning.is_warning);
  return Brief(read->warnings);
}

TEST(PlausibleSizes, AMassIsComparedWithTheShape) {
  EXPECT_EQ(Warned("mass_kg: 0.4", "mass_kg: 0.5"), "");
  EXPECT_EQ(Warned("mass_kg: 0.4", "mass_kg: 500"),
            "7:54: mass_kg: 500 kg are much for 'milk', whose shape has 0.98 litres: 510 kg per "
            "litre | water has 1, lead 11; a mass is in kg, a size in metres\n");
  EXPECT_EQ(Warned("mass_kg: 0.4", "mass_kg: 0.001"),
            "7:54: mass_kg: 0.001 kg are little for 'milk', whose shape has 0.98 litres: 0.00102 "
            "kg per litre | air has 0.001, foam 0.02; a mass is in kg, a size in metres\n");
}

TEST(PlausibleSizes, ASizeIsThatOfSomethingThatAHandDealsWith) {
  EXPECT_EQ(Warned("size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4",
                   "size_m: [40, 0.07, 0.20]}, mass_kg: 300"),
            "7:3: 'milk' is 40 m long, and it is not fixed | sizes are in metres: 0.1 is 10 cm\n");
  EXPECT_EQ(Warned("size_m: [1.2, 0.8, 0.04]", "size_m: [80, 0.8, 0.04]"),
            "6:3: 'table' is 80 m long | sizes are in metres: 0.1 is 10 cm\n");
  EXPECT_EQ(Warned("size_m: [1.2, 0.8, 0.04]", "size_m: [20, 0.8, 0.04]"), "");
}

TEST(PlausibleHands, AHandOfTheOtherSideIsTold) {
  const auto hand = [](const std::string& text) {
    return Warned("right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}", text);
  };
  const std::string left = "hand: human_left, at_m: [-0.2, -0.2, 1.05]}";
  EXPECT_EQ(hand("right_hand: {" + left),
            "9:22: right_hand: 'human_left' is a left hand | its thumb is on the other side; name "
            "what is meant\n");
  const std::string two =
      "right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}\n  leftmost: {hand: human_left, "
      "at_m: [-0.2, 0.2, 1.05]}\n  anna: {person: body, at_m: [-0.6, 0, 0], ";
  EXPECT_EQ(hand(two + "right_hand: right_hand, left_hand: leftmost}"), "");
  EXPECT_EQ(hand(two + "left_hand: right_hand}"),
            "11:55: left_hand: 'right_hand' is a right hand | its thumb is on the other side; name "
            "what is meant\n");
}

/// Of a tower of three, each counts what stands on it and on that.
TEST(PlausibleSizes, AHundredTimesItsMassStandsOnIt) {
  const auto tower = [](const std::string& light_kg) {
    return "mass_kg: " + light_kg +
           ", on: table, at_m: [0.5, 0]}\n  pot: {box: {size_m: [0.1, 0.1, 0.1]}, mass_kg: 2, on: "
           "milk, at_m: [0.5, 0]}\n  lid: {box: {size_m: [0.1, 0.1, 0.02]}, mass_kg: 1, on: pot, "
           "at_m: [0.5, 0]}\n  spare: {box: {size_m: [0.07, 0.07, 0.2]}, mass_kg: 0.4";
  };
  EXPECT_EQ(Warned("mass_kg: 0.4", tower("0.031")), "");
  EXPECT_EQ(Warned("mass_kg: 0.4", tower("0.025")),
            "7:54: mass_kg: 120 times as much as 'milk' weighs stands on it, and from 100 times on "
            "it may sink in | make it heavier, or what stands on it lighter; or raise 'world: "
            "{rate_hz: ..}'\n");
}

}  // namespace
}  // namespace prehend::scenario

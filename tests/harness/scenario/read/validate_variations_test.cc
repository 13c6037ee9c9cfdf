// SPDX-License-Identifier: Apache-2.0
// What can be drawn is tried when the file is read: paths, bounds, and what the rest of the
// scenario has against them.
#include <gtest/gtest.h>

#include "harness/scenario/read/read_scenario.h"
#include "harness/scenario/read/sample_variations.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

std::string ErrorsOfVariations(const std::string& variations,
                               const std::vector<std::string>& settings = {}) {
  return Brief(ErrorsOf(
      ReadScenarioText("probe.yaml", kProbe + ("vary:\n" + variations), settings, ProbeLibrary())));
}

TEST(CheckDraws, FieldsHaveToBeThere) {
  const std::pair<const char*, const char*> cases[] = {
      {"- {fields: [entities.mlik.mass_kg], uniform: [0, 1]}",
       "16:15: fields: the scenario has no 'entities.mlik.mass_kg' | did you mean 'milk'?\n"},
      {"- {fields: [entities.milk.masskg], uniform: [0.1, 1]}",
       "16:15: with entities.milk.masskg=0.100000: unknown key 'masskg' in entity 'milk' | did you "
       "mean 'mass_kg'?\n"},
      {"- {fields: [entities.milk.at_m.3], uniform: [0, 1]}",
       "16:15: fields: the scenario has no 'entities.milk.at_m.3' | 'at_m' is a list of 2\n"},
      {"- {fields: [wrld.seed], uniform: [0, 1]}",
       "16:15: fields: the scenario has no 'wrld.seed' | did you mean 'world'?\n"},
      {"- {fields: [entities.milk.friction], times: [0.9, 1.1]}",
       "16:15: fields: the scenario has no 'entities.milk.friction' | plus and times need a "
       "written number\n"},
      {"- {fields: [entities.milk.on], plus: [0, 1]}",
       "16:15: fields: 'entities.milk.on' is not a number\n"},
      {"- {fields: [vary.0.uniform.0], uniform: [0, 1]}",
       "16:15: fields: 'vary' itself cannot be varied\n"},
      {"- {fields: [entities.milk.mass_kg]}",
       "16:5: a variation needs one of the keys uniform, normal, plus, times, choose\n"}};
  for (const auto& [line, complaint] : cases)
    EXPECT_EQ(ErrorsOfVariations("  " + std::string(line) + "\n"), complaint);
}

TEST(CheckDraws, NoFieldIsVariedTwice) {
  EXPECT_EQ(ErrorsOfVariations(
                "  - {fields: [entities.milk.mass_kg], uniform: [0.1, 1]}\n"
                "  - {fields: [entities.milk.at_m.0, entities.milk.mass_kg], times: [1, 2]}\n"),
            "17:37: fields: 'entities.milk.mass_kg' is varied twice | give it one distribution\n");
  EXPECT_EQ(ErrorsOfVariations(
                "  - {fields: [entities.milk.at_m.0, entities.milk.at_m.00], plus: [0, 0.01]}\n"),
            "16:37: fields: 'entities.milk.at_m.00' is varied twice | give it one distribution\n");
  EXPECT_EQ(ErrorsOfVariations("  - {fields: [settle_s, settle_s], uniform: [0, 0.01]}\n"),
            "16:25: fields: 'settle_s' is varied twice | give it one distribution\n");
}

TEST(CheckDraws, BoundsHaveToBeReadable) {
  const std::pair<const char*, const char*> cases[] = {
      {"- {fields: [entities.milk.mass_kg], uniform: [1, 0]}",
       "16:48: uniform: expected [min, max], found [1, 0]\n"},
      {"- {fields: [entities.milk.mass_kg], normal: [1, -1]}",
       "16:47: normal: expected [mean, deviation] with a deviation of at least 0, found [1, -1]\n"},
      {"- {fields: [entities.milk.mass_kg], uniform: [-1, 0.5]}",
       "16:49: with entities.milk.mass_kg=-1.000000: mass_kg: expected a number from 0.001 to "
       "1000, found "
       "'-1.000000'\n"},
      {"- {fields: [entities.milk.mass_kg], uniform: [0.1, 2000]}",
       "16:54: with entities.milk.mass_kg=2000.000000: mass_kg: expected a number from 0.001 to "
       "1000, found "
       "'2000.000000'\n"},
      {"- {fields: [entities.milk.mass_kg], normal: [0.4, 0.2]}",
       "16:48: with entities.milk.mass_kg=-0.200000: mass_kg: expected a number from 0.001 to "
       "1000, found "
       "'-0.200000'\n"},
      {"- {fields: [entities.milk.class], uniform: [0, 1]}",
       "16:47: with entities.milk.class=0.000000: class: expected a class name like 'MilkCarton', "
       "found the number "
       "0.000000 | use choose: [...] for texts\n"},
      {"- {fields: [script.0.right_hand.style], choose: [wrap, pich]}",
       "16:58: with script.0.right_hand.style=pich: style: hand 'human_right' has no style 'pich' "
       "| did you mean "
       "'pinch'?\n"},
      {"- {fields: [entities.milk.at_m.0], plus: [0, 0.6]}",
       "16:48: with entities.milk.at_m.0=0.800000: at_m: the centre of 'milk' is not above 'table' "
       "| at_m is in world "
       "coordinates, also with 'on'\n"}};
  for (const auto& [line, complaint] : cases)
    EXPECT_EQ(ErrorsOfVariations("  " + std::string(line) + "\n"), complaint);
}

TEST(CheckDraws, WhatTheFileLeavesOutCanBeVaried) {
  EXPECT_EQ(ErrorsOfVariations("  - {fields: [world.seed], uniform: [1, 100]}\n"), "");
  EXPECT_EQ(ErrorsOfVariations("  - {fields: [settle_s], uniform: [0.1, 0.2]}\n"), "");
  EXPECT_EQ(ErrorsOfVariations("  - {fields: [entities.milk.friction], normal: [0.8, 0.1]}\n"), "");
}

TEST(CheckDraws, WhatTheCommandLineSetsIsNotVaried) {
  EXPECT_EQ(ErrorsOfVariations("  - {fields: [entities.milk.mass_kg], uniform: [-1, 0.5]}\n",
                               {"entities.milk.mass_kg=1"}),
            "");
}

}  // namespace
}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
#include "tests/harness/scenario_fixture.h"

#include <gtest/gtest.h>

namespace prehend::scenario {

const char* const kProbe = R"(scenario: probe
shows: a carton on a table
grammar: pick_and_place
world: {engine: bullet, rate_hz: 480, sensing_hz: 240, seed: 1}
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  milk: {box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4, on: table, at_m: [0.2, 0.1]}
actors:
  right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}
script:
  - right_hand: {reach: milk, style: wrap, over_s: 0.8}
  - right_hand: {close_to: 1.0}
pictures:
  - {at: reaching.begin, camera: front}
)";

ScenarioLibrary ProbeLibrary() {
  return {.grammars = {"pick_and_place"},
          .hands = {"human_left", "human_right"},
          .read_hand = [](const std::string& name,
                          const std::vector<std::string>&) -> Result<physics::HandModel> {
            if (name.ends_with("broken.hand.yaml")) {
              return tl::unexpected(
                  grammar::Diagnostics{{.file = name, .place = {3, 4}, .message = "no links"}});
            }
            physics::HandModel model;
            model.name = name;
            model.translation = {
                .proportional = 2500, .derivative = 120, .integral = 2000, .limit = 80};
            model.rotation = {.proportional = 20, .derivative = 0.5, .integral = 20, .limit = 8};
            model.styles.push_back({.name = "wrap",
                                    .frames = {{}, {}},
                                    .above = physics::GraspApproach{},
                                    .side = physics::GraspApproach{}});
            model.styles.push_back(
                {.name = "pinch", .frames = {{}, {}}, .above = physics::GraspApproach{}});
            return model;
          }};
}

std::string ProbeWith(const std::string& from, const std::string& to) {
  std::string text = kProbe;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from << " is not unique";
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

std::string Brief(const grammar::Diagnostics& diagnostics) {
  std::string all;
  for (const auto& d : diagnostics) {
    if (d.file != "probe.yaml") all += d.file + ":";
    all += std::to_string(d.place.line) + ":" + std::to_string(d.place.column) + ": " + d.message;
    if (!d.hint.empty()) all += " | " + d.hint;
    all += "\n";
  }
  return all;
}

}  // namespace prehend::scenario

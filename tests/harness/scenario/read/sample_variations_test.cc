// SPDX-License-Identifier: Apache-2.0
// Trials: the same draws for the same seed, within their bounds, and nothing varied that is not
// there.
#include "harness/scenario/read/sample_variations.h"

#include <gtest/gtest.h>

#include "harness/scenario/read/read_scenario.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

Result<Scenario> ReadVarying(const std::string& vary) {
  return ReadScenarioText("probe.yaml", kProbe + vary, {}, ProbeLibrary());
}

std::vector<std::string> Draw(const std::string& vary, std::uint64_t seed, int trial) {
  const auto read = ReadVarying(vary);
  EXPECT_TRUE(read) << Brief(ErrorsOf(read));
  if (!read) return {};
  const auto document = ParseYaml("probe.yaml", kProbe + vary);
  return SampleTrial(*document, read->variations, seed, trial);
}

double NumberIn(const std::string& setting) {
  return std::stod(setting.substr(setting.find('=') + 1));
}

const std::string kMass = "vary:\n  - {fields: [entities.milk.mass_kg], uniform: [0.2, 0.5]}\n";

TEST(Vary, ChoosesAmongNumbersAndFlagsToo) {
  const std::string drawn =
      Draw("vary:\n  - {fields: [entities.milk.mass_kg], choose: [0.25, 0.3]}\n", 1, 1)[0];
  EXPECT_TRUE(drawn == "entities.milk.mass_kg=0.25" || drawn == "entities.milk.mass_kg=0.3")
      << drawn;
  EXPECT_EQ(Draw("vary:\n  - {fields: [world.planar], choose: [false]}\n", 1, 1)[0],
            "world.planar=false");
  EXPECT_FALSE(ReadVarying("vary:\n  - {fields: [world.planar], choose: [no]}\n"));
}

TEST(Vary, IsNotCheckedAgainWhereTheScenarioWasPlayed) {
  const std::string vary = "vary:\n  - {fields: [entities.milk.mass_kg], choose: [-1]}\n";
  EXPECT_FALSE(ReadVarying(vary));
  ScenarioLibrary library = ProbeLibrary();
  library.were_played = true;
  const auto read = ReadScenarioText("probe.yaml", kProbe + vary, {}, library);
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  EXPECT_EQ(read->variations.size(), 1u);
}

TEST(Vary, TheSameTrialIsTheSameDraw) {
  EXPECT_EQ(Draw(kMass, 1, 7), Draw(kMass, 1, 7));
  EXPECT_NE(Draw(kMass, 1, 7), Draw(kMass, 1, 8));
  EXPECT_NE(Draw(kMass, 1, 7), Draw(kMass, 2, 7));
  // Another variation after it changes nothing.
  const std::string more = kMass + "  - {fields: [entities.milk.friction], uniform: [0.7, 0.9]}\n";
  EXPECT_EQ(Draw(more, 1, 7)[0], Draw(kMass, 1, 7)[0]);
}

TEST(Vary, DrawsStayWithinTheirBoundsAndFillThem) {
  double least = 1, most = 0, sum = 0;
  for (int trial = 1; trial <= 400; ++trial) {
    const double mass_kg = NumberIn(Draw(kMass, 1, trial)[0]);
    least = std::min(least, mass_kg);
    most = std::max(most, mass_kg);
    sum += mass_kg;
  }
  EXPECT_GE(least, 0.2);
  EXPECT_LT(least, 0.21);
  EXPECT_LE(most, 0.5);
  EXPECT_GT(most, 0.49);
  EXPECT_NEAR(sum / 400, 0.35, 0.015);
}

TEST(Vary, RelativeDrawsStartFromWhatIsWritten) {
  const std::string vary =
      "vary:\n  - {fields: [entities.milk.at_m.0, actors.right_hand.at_m.0], plus: [-0.008, "
      "0.008]}\n"
      "  - {fields: [entities.milk.box.size_m.2], times: [0.9, 1.1]}\n";
  for (int trial = 1; trial <= 20; ++trial) {
    const auto settings = Draw(vary, 3, trial);
    ASSERT_EQ(settings.size(), 3u);
    EXPECT_NEAR(NumberIn(settings[0]), 0.2, 0.008);
    EXPECT_NEAR(NumberIn(settings[1]) - NumberIn(settings[0]), -0.4, 2e-6);  // one draw for both
    EXPECT_NEAR(NumberIn(settings[2]), 0.2, 0.0201);
    EXPECT_TRUE(ReadScenarioText("probe.yaml", kProbe, settings, ProbeLibrary()));
  }
}

TEST(Vary, NormalAndChosenDraws) {
  const std::string vary =
      "vary:\n  - {fields: [entities.milk.friction], normal: [0.8, 0.05]}\n"
      "  - {fields: [script.0.right_hand.style], choose: [wrap, pinch]}\n";
  double sum = 0, squares = 0;
  int pinches = 0;
  for (int trial = 1; trial <= 400; ++trial) {
    const auto settings = Draw(vary, 1, trial);
    const double off = NumberIn(settings[0]) - 0.8;
    sum += off;
    squares += off * off;
    pinches += settings[1] == "script.0.right_hand.style=pinch";
  }
  EXPECT_NEAR(sum / 400, 0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / 400), 0.05, 0.005);
  EXPECT_NEAR(pinches, 200, 40);
}

TEST(Vary, ChanceStaysWithinThreeDeviations) {
  const std::string vary = "vary:\n  - {fields: [entities.milk.friction], normal: [0.8, 0.2]}\n";
  for (int trial = 1; trial <= 2000; ++trial)
    ASSERT_NEAR(NumberIn(Draw(vary, 1, trial)[0]), 0.8, 0.600001);
}

TEST(Vary, WhereNumberFromsAreWantedTheNearestIsDrawn) {
  EXPECT_EQ(Draw("vary:\n  - {fields: [world.seed], uniform: [7.6, 8.4]}\n", 1, 1)[0],
            "world.seed=8");
  EXPECT_EQ(Draw("vary:\n  - {fields: [settle_s], uniform: [0.5, 0.5]}\n", 1, 1)[0],
            "settle_s=0.500000");
}

}  // namespace
}  // namespace prehend::scenario

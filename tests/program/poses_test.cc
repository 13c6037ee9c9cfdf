// SPDX-License-Identifier: Apache-2.0
// Where everything is at a moment, ready to paste into a scenario.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

TEST(Poses, OfAScenarioAndItsEpisodeAreTheSame) {
  const auto record = (FreshFolder("poses") / "a.episodes").string();
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--record", record}).exit_code, 0);
  const Said played =
      Prehend({"scenario", "poses", "milk_carton_wrap", "--at", "transporting.begin"});
  const Said recorded = Prehend({"scenario", "poses", record, "--at", "transporting.begin"});
  EXPECT_EQ(played.exit_code, 0) << played.err;
  EXPECT_EQ(played.out, recorded.out);
  EXPECT_NE(played.out.find("# end of index_distal"), std::string::npos) << played.out;
}

TEST(Poses, AreThoseOfTheScenarioAtItsBegin) {
  const Said said = Prehend({"scenario", "poses", "milk_carton_wrap", "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const auto poses = nlohmann::json::parse(said.out);
  EXPECT_NEAR(poses["entities"]["table"]["at_m"][2], 0.74, 1e-12);
  EXPECT_NEAR(poses["entities"]["milk"]["at_m"][0], 0.2, 1e-4);
  EXPECT_LT(poses["time_s"], 0.01);
  EXPECT_EQ(poses["hands"]["right_hand"]["tips"].size(), 5u);
}

TEST(Poses, AMomentThatIsNoneIsExplained) {
  const Said bad = Prehend({"scenario", "poses", "milk_carton_wrap", "--at", "graspng.begin"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("graspng"), std::string::npos) << bad.err;
}

TEST(Poses, ScenariosAreListedAsTheyAreChecked) {
  const Said some = Prehend({"list", "slide/*", "--filter", "tag:claim", "--json"});
  ASSERT_EQ(some.exit_code, 0) << some.err;
  const auto listed = nlohmann::json::parse(some.out)["scenarios"];
  ASSERT_FALSE(listed.empty());
  for (const auto& one : listed)
    EXPECT_EQ(one["scenario"].get<std::string>().substr(0, 6), "slide/");
  EXPECT_EQ(Prehend({"list", "no_such_*"}).exit_code, 4);
}

}  // namespace
}  // namespace prehend::house

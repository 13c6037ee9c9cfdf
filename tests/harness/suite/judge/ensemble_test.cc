// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/episode/run/run_scenario.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/claims/claim.h"

namespace prehend::suite {
namespace {

// A golden may be marked as unsteady; what the scenario expects must hold everywhere all the same.
TEST(Ensemble, ClaimsAreJudgedInEachPlay) {
  const std::string root = PREHEND_SOURCE_DIR;
  episode::LoadedRun loaded =
      episode::LoadRun({.scenario_file = root + "/scenarios/planar/disc_rolls_to_rest.yaml"}, root)
          .value();
  loaded.scenario.expects = {truth::ParseClaim("no contact(disc, ramp)").value()};
  const grammar::Timeline here = episode::RunScenario(loaded.scenario, loaded.program).timeline;
  truth::Golden golden{.ticks_per_second = here.ticks_per_second};
  golden.unsteady = "chaos";
  for (const grammar::NamedEvent& event : here.events) golden.events.push_back({.event = event});
  const Ensemble ensemble = PlayEnsemble(loaded, here, golden);
  EXPECT_EQ(ensemble.plays, 6);
  EXPECT_EQ(ensemble.plays_broken, 5);
  ASSERT_EQ(ensemble.broken.size(), 5u);
  EXPECT_NE(ensemble.broken[0].reason.find("nudge: expects: 'no contact(disc, ramp)'"),
            std::string::npos)
      << ensemble.broken[0].reason;
  EXPECT_NE(ensemble.broken[0].details.find("contact(disc, ramp) 0.0"), std::string::npos);
  EXPECT_TRUE(ensemble.differences.empty());
  golden.events.pop_back();
  EXPECT_EQ(PlayEnsemble(loaded, here, golden).differences.size(), 5u);
}

}  // namespace
}  // namespace prehend::suite

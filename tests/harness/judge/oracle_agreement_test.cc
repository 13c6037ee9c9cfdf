// SPDX-License-Identifier: Apache-2.0
// What the shipped grammars find in every shipped scenario against what the oracle says truly
// happened in it. `prehend check` plays every scenario and lets the oracle judge what is found,
// with a tolerance of two frames; it fails unless as many events differ as the golden's header
// says. So most scenarios need not be played again here: it is enough that their goldens say that
// all follow.
#include <gtest/gtest.h>

#include <algorithm>

#include "grammar/program/program.h"
#include "harness/golden/compare.h"
#include "harness/golden/golden_files.h"
#include "harness/judge/compare_with_oracle.h"
#include "harness/oracle/oracle.h"
#include "harness/run/find_scenario.h"
#include "harness/run/load_run.h"
#include "harness/run/run_scenario.h"
#include "harness/timeline/match_events.h"

namespace prehend::harness {
namespace {

// Two frames at the usual 240 Hz: the grammar senses, the oracle looks at the surfaces themselves.
constexpr grammar::Tick kTolerance = 4;

class OracleAgreement : public testing::TestWithParam<ScenarioFile> {};

bool Defines(const grammar::NamedEvent& event) { return OracleDefines(event.event); }

bool SpeaksOfIt(const grammar::Program& program) {
  return std::ranges::any_of(program.rules, [](const grammar::Rule& rule) {
    return rule.printed && OracleDefines(rule.name);
  });
}

/// Of a scenario whose two frames are at most kTolerance, for which `check` does the rest.
void ExpectAllToFollow(const ScenarioFile& file, const grammar::Program& program) {
  const auto golden = GoldenFiles(PREHEND_SOURCE_DIR).ReadGoldenOf(IdOf(file));
  ASSERT_TRUE(golden && *golden) << "no golden, or one that cannot be read\n"
                                 << grammar::Format(ErrorsOf(golden));
  const std::vector<GoldenEvent>& lines = (*golden)->events;
  EXPECT_FALSE(lines.empty());
  const std::vector<std::string>& derived = (*golden)->derived;
  EXPECT_TRUE(std::ranges::any_of(
      derived, [](const std::string& line) { return line.starts_with(kOracleLine); }));
  EXPECT_EQ(AcceptedDiffering(derived), 0);
  EXPECT_TRUE(!SpeaksOfIt(program) || std::ranges::any_of(lines, Defines, &GoldenEvent::event));
}

void ExpectAgreement(const Scenario& scenario,
                     const std::shared_ptr<const grammar::Program>& program) {
  const RunResult run = RunScenario(scenario, program, {.record = true});
  ASSERT_EQ(run.status.kind, physics::RunStatus::Kind::kCompleted) << run.status.reason;
  EXPECT_FALSE(run.timeline.events.empty());
  const Judged judged = JudgedByOracle(scenario, *program, run);
  EXPECT_TRUE(!SpeaksOfIt(*program) || !judged.truth.events.empty());
  EXPECT_EQ(DescribeDisagreement(Agree(judged.truth, judged.found, kTolerance), kTolerance), "");
}

TEST_P(OracleAgreement, WithinTwoFrames) {
  const RunRequest request{.scenario_file = GetParam().path};
  const Result<LoadedRun> loaded = LoadRun(request, PREHEND_SOURCE_DIR);
  ASSERT_TRUE(loaded) << grammar::Format(loaded.error());
  const Scenario& scenario = loaded->scenario;
  const bool check_is_as_strict = DefaultTolerance(scenario) <= kTolerance;
  if (check_is_as_strict)
    ExpectAllToFollow(GetParam(), *loaded->program);
  else
    ExpectAgreement(scenario, loaded->program);
}

INSTANTIATE_TEST_SUITE_P(Shipped, OracleAgreement,
                         testing::ValuesIn(ListScenarios(PREHEND_SOURCE_DIR)),
                         [](const auto& scenario) {
                           return scenario.param.skill + "_" + scenario.param.name;
                         });

}  // namespace
}  // namespace prehend::harness

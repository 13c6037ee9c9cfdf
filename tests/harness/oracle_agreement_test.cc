// SPDX-License-Identifier: Apache-2.0
// What the shipped grammars find in every shipped scenario against what the oracle says truly
// happened in it.
#include <gtest/gtest.h>

#include <algorithm>

#include "grammar/program.h"
#include "harness/derivation.h"
#include "harness/library_paths.h"
#include "harness/oracle/agreement.h"
#include "harness/oracle/oracle.h"
#include "harness/prepare_run.h"
#include "harness/run_scenario.h"

namespace prehend::harness {
namespace {

// Two frames at the usual 240 Hz: the grammar senses, the oracle looks at the surfaces themselves.
constexpr grammar::Tick kTolerance = 4;

class OracleAgreement : public testing::TestWithParam<ScenarioFile> {};

TEST_P(OracleAgreement, WithinTwoFrames) {
  const RunRequest request{.scenario_file = GetParam().path};
  const ReadResult<PreparedRun> prepared = PrepareRun(request, PREHEND_SOURCE_DIR);
  ASSERT_TRUE(prepared.value) << grammar::Format(prepared.diagnostics);
  const Scenario& scenario = prepared.value->scenario;
  const auto& program = prepared.value->program;
  const RunResult run = RunScenario(scenario, program, {.record = true});
  ASSERT_EQ(run.status.kind, physics::RunStatus::Kind::kCompleted) << run.status.reason;
  EXPECT_FALSE(run.timeline.events.empty());
  const Judged judged = JudgedByOracle(scenario, *program, run);
  const bool speaks_of_it = std::ranges::any_of(program->events, [](const grammar::Rule& rule) {
    return rule.printed && OracleDefines(rule.name);
  });
  if (speaks_of_it) {
    EXPECT_GE(judged.truth.events.size(), 1u);
  }
  EXPECT_EQ(DescribeDisagreement(Agree(judged.truth, judged.found, kTolerance), kTolerance), "");
}

INSTANTIATE_TEST_SUITE_P(Shipped, OracleAgreement,
                         testing::ValuesIn(ListScenarios(PREHEND_SOURCE_DIR)),
                         [](const auto& scenario) { return scenario.param.skill + "_" + scenario.param.name; });

}  // namespace
}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// What a run needs, from files: settings go to the scenario or to its grammar, all problems are
// reported at once, and every file that was used is named.
#include "harness/episode/run/load_run.h"

#include "grammar/program/program.h"
#include "harness/episode/run/run_trials.h"
#include "tests/harness/episode/run/count_reads.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::episode {
namespace {

class PrepareRunTest : public suite::CheckedScenario {
 protected:
  Result<LoadedRun> Prepared(const std::vector<std::string>& settings,
                             const std::string& grammar = {}) {
    RunRequest request = Request();
    request.settings = settings;
    request.grammar = grammar;
    files_.clear();
    return LoadRun(request, root_.string(), &files_);
  }
  std::string Problems(const std::vector<std::string>& settings, const std::string& grammar = {}) {
    std::string text;
    for (const grammar::Diagnostic& problem : ErrorsOf(Prepared(settings, grammar)))
      text += problem.message + (problem.hint.empty() ? "" : " | " + problem.hint) + "\n";
    return text;
  }

  std::vector<std::string> files_;
};

TEST_F(PrepareRunTest, SettingsGoToTheScenarioOrToItsGrammar) {
  const auto loaded = Prepared({"settle_s=0.25", "entities.carton.mass_kg=2", "lift_rise=10cm"});
  ASSERT_TRUE(loaded) << Format(ErrorsOf(loaded));
  EXPECT_EQ(loaded->scenario.scene.bodies[1].mass_kg, 2);
  EXPECT_EQ(loaded->scenario.grammar, "pick_and_place");
  const auto& params = loaded->program->params;
  const auto rise = std::ranges::find(params, "lift_rise", &grammar::ProgramParam::name);
  ASSERT_NE(rise, params.end());
  EXPECT_TRUE(rise->overridden);
  EXPECT_TRUE(IsFieldOfScenario("settle_s"));
  EXPECT_TRUE(IsFieldOfScenario("world.seed"));
  EXPECT_FALSE(IsFieldOfScenario("lift_rise"));
}

TEST_F(PrepareRunTest, EveryFileThatWasUsedIsNamed) {
  ASSERT_TRUE(Prepared({}));
  EXPECT_EQ(files_.front(), Request().scenario_file);
  const std::string grammar = (root_ / "grammar/library/pick_and_place.grammar").string();
  EXPECT_EQ(std::ranges::count(files_, grammar), 1);
}

TEST_F(PrepareRunTest, AScenarioIsReadOnce) {
  Write("scenarios/rest/carton_stands.yaml",
        std::string(suite::kCartonStands) + "expects: [\"one supported_by(carton, table)\"]\n" +
            "vary: [{fields: [entities.carton.mass_kg], times: [0.8, 1.2]}]\n");
  const CountReads reads(Request().scenario_file);
  const auto loaded = Prepared({"settle_s=0.25"});
  ASSERT_TRUE(loaded) << Format(ErrorsOf(loaded));
  UndecidedClaims(loaded->scenario, loaded->document, *loaded->program);
  EXPECT_EQ(reads.Count(), 1);
  ASSERT_TRUE(RequestOfTrial(Request(), root_.string(), 1));
  EXPECT_EQ(reads.Count(), 1) << "values are drawn from what was read";
  ASSERT_FALSE(Prepared({"settle_s=soon"}));
  EXPECT_EQ(reads.Count(), 1) << "its grammar is known, too, if it cannot be read";
}

TEST_F(PrepareRunTest, SettingsThatAreNoneAreRefused) {
  EXPECT_EQ(Problems({"settle_s"}),
            "expected NAME=VALUE | --set reach_radius=25cm, --set entities.milk.mass_kg=8\n");
  EXPECT_EQ(Problems({"settle_s=1", "settle_s=2"}),
            "the same name is set twice | give each --set a name of its own\n");
}

TEST_F(PrepareRunTest, ProblemsOfScenarioAndGrammarAreReportedTogether) {
  Write("rules.grammar", "grammar rules\nevent touching_it(a: Entity)\n  while");
  const auto loaded = Prepared({"settle_s=soon"}, (root_ / "rules.grammar").string());
  ASSERT_FALSE(loaded);
  std::vector<std::string> files;
  for (const grammar::Diagnostic& problem : loaded.error()) files.push_back(problem.file);
  EXPECT_EQ(files, (std::vector<std::string>{"--set", (root_ / "rules.grammar").string()}));
}

TEST_F(PrepareRunTest, APictureOfAnEventThatTheGrammarLacksIsRefused) {
  Write("scenarios/rest/carton_stands.yaml",
        std::string(suite::kCartonStands) + "pictures: [{at: graspin.begin}]\n");
  const auto loaded = Prepared({});
  ASSERT_FALSE(loaded);
  ASSERT_EQ(loaded.error().size(), 1u);
  EXPECT_EQ(loaded.error()[0].place.line, 7);
  EXPECT_TRUE(loaded.error()[0].message.starts_with("at: ")) << loaded.error()[0].message;
}

}  // namespace
}  // namespace prehend::episode

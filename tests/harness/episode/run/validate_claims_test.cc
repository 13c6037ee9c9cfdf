// SPDX-License-Identifier: Apache-2.0
// Claims about what the scenario or its grammar does not have are refused when they are read;
// another grammar may lack what they are about.
#include "harness/episode/run/load_run.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::episode {
namespace {

class ValidateClaimsTest : public suite::CheckedScenario {
 protected:
  Result<LoadedRun> LoadedWith(const std::string& claims, const std::string& grammar = {}) const {
    Write("scenarios/rest/carton_stands.yaml",
          std::string(suite::kCartonStands) + "expects:\n" + claims);
    RunRequest request = Request();
    request.grammar = grammar;
    return LoadRun(request, root_.string());
  }
  std::string Problems(const std::string& claims, const std::string& grammar = {}) const {
    std::string text = Format(ErrorsOf(LoadedWith(claims, grammar)));
    for (std::size_t at; (at = text.find(root_.string())) != std::string::npos;)
      text.erase(at, root_.string().size() + 1);
    return text;
  }
};

TEST_F(ValidateClaimsTest, WhatIsKnownIsFine) {
  EXPECT_EQ(Problems("  - one supported_by(carton, table)\n  - contact(table, carton)\n"), "");
}

TEST_F(ValidateClaimsTest, UnknownNamesAreShownInTheFile) {
  EXPECT_EQ(Problems("  - no slidin\n  - one supported_by(carton, tabel)\n"),
            "scenarios/rest/carton_stands.yaml:8:8: error: expects: grammar 'pick_and_place' has "
            "no event 'slidin'\n"
            "    - no slidin\n"
            "         ^\n"
            "  hint: did you mean 'sliding'?\n"
            "scenarios/rest/carton_stands.yaml:9:30: error: expects: the scenario has no 'tabel'\n"
            "    - one supported_by(carton, tabel)\n"
            "                               ^\n"
            "  hint: did you mean 'table'?\n");
}

TEST_F(ValidateClaimsTest, AnotherGrammarMayLackTheEvents) {
  const auto loaded = LoadedWith("  - no opening(carton)\n  - one contact\n", "furniture");
  ASSERT_TRUE(loaded) << Format(ErrorsOf(loaded));
  const grammar::Diagnostics warnings =
      UndecidedClaims(loaded->scenario, loaded->document, *loaded->program);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_TRUE(warnings[0].is_warning);
  EXPECT_EQ(warnings[0].message,
            "expects: not judged: 'carton' is never 'part' of 'opening', which takes a Jointed");
  EXPECT_EQ(warnings[1].message, "expects: not judged: grammar 'furniture' has no event 'contact'");
  EXPECT_EQ(warnings[1].place.line, 9);
}

TEST_F(ValidateClaimsTest, AnEntityThatIsNotThereIsWrongWithAnyGrammar) {
  EXPECT_EQ(Problems("  - no opening(drawer)\n", "furniture"),
            "scenarios/rest/carton_stands.yaml:8:16: error: expects: the scenario has no "
            "'drawer'\n"
            "    - no opening(drawer)\n"
            "                 ^\n"
            "  hint: known: table, carton\n");
}

}  // namespace
}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// The blame names what moved otherwise, or says that nothing did, and which files changed.
#include "harness/check/blame.h"

#include <gtest/gtest.h>

namespace prehend::harness {
namespace {

struct Runs {
  CheckRecord last_agreed{.program = "p", .pictures = false, .verdict = {.scenario = "slide/x"}};
  PhysicsTrace trace{.entities = {"cup"}, .ticks = {0, 2}, .hashes = {1, 2}};
  Suspect now{.program = "p", .inputs = {}, .trace = trace, .ticks_per_second = 480};
  Runs() {
    last_agreed.verdict.inputs = {{"/root/a.grammar", "1"}, {"/root/x.yaml", "2"}};
    now.inputs = last_agreed.verdict.inputs;
  }
  std::string Text() const { return BlameText(last_agreed, trace, now, "/root"); }
};

TEST(Blame, IsTheGrammarsWhenEverythingMovesAsBefore) {
  Runs runs;
  runs.now.inputs["/root/a.grammar"] = "3";
  EXPECT_EQ(runs.Text(),
            "blame: the grammar or the golden: everything moves as when this last agreed with its "
            "golden; changed since then: a.grammar\n");
}

TEST(Blame, IsThePhysicsFromWhereItParts) {
  Runs runs;
  runs.now.trace.hashes[1] = 7;
  runs.now.program = "q";
  runs.now.inputs.erase("/root/x.yaml");
  runs.now.inputs["/elsewhere/y.yaml"] = "2";
  EXPECT_EQ(runs.Text(),
            "blame: physics: since 0.0042 s (tick 2) cup does not move as when this last agreed "
            "with its golden; changed since then: /elsewhere/y.yaml, x.yaml, the program\n");
  runs.now.trace = {.entities = {"mug"}, .ticks = {0}, .hashes = {1}};
  EXPECT_TRUE(runs.Text().starts_with("blame: physics: other entities; ")) << runs.Text();
}

TEST(Blame, WithoutAnyChangedFileNothingIsKnown) {
  Runs runs;
  runs.now.trace.ticks.pop_back();
  runs.now.trace.hashes.pop_back();
  EXPECT_EQ(
      runs.Text(),
      "blame: physics: since 0.0042 s (tick 2) the run is not as long as when this last agreed "
      "with its golden; changed since then: nothing that is known\n");
}

TEST(Blame, IsTheLooksWhenTheyAreAtOtherTicksOfTheSameMotion) {
  Runs runs;
  runs.trace = {.entities = {"cup"}, .ticks = {0, 2, 4, 6, 8, 10}, .hashes = {1, 2, 3, 4, 5, 6}};
  runs.now.trace = {.entities = {"cup"}, .ticks = {0, 4, 8}, .hashes = {1, 3, 5}};
  runs.now.options = {"--set world.sensing_hz=60"};
  EXPECT_EQ(runs.Text(),
            "blame: the looks are at other ticks; where both look everything moves as when this "
            "last agreed with its golden; changed since then: --set world.sensing_hz=60\n");
  runs.now.trace.hashes[1] = 7;
  EXPECT_TRUE(runs.Text().starts_with("blame: physics: since 0.0083 s (tick 4) cup does not move "))
      << runs.Text();
  runs.now.trace = {.entities = {"cup"}, .ticks = {0, 4}, .hashes = {1, 3}};
  EXPECT_TRUE(
      runs.Text().starts_with("blame: physics: since 0.0125 s (tick 6) the run is not as "
                              "long "))
      << runs.Text();
}

TEST(Blame, AGrammarThatTheCommandLineChoseDidNotChange) {
  Runs runs;
  runs.now.inputs.erase("/root/a.grammar");
  runs.now.inputs["/root/b.grammar"] = "4";
  runs.now.options = {"--grammar b", "--set slide_min=2s"};
  runs.now.other_grammar = true;
  const std::string with_options = runs.Text();
  EXPECT_TRUE(with_options.ends_with("; changed since then: --grammar b, --set slide_min=2s\n"))
      << with_options;
  runs.now.options.clear();
  runs.now.other_grammar = false;
  EXPECT_TRUE(runs.Text().ends_with("; changed since then: b.grammar, a.grammar\n")) << runs.Text();
}

TEST(Blame, IsUnknownWithoutARunThatAgreed) {
  const Runs runs;
  EXPECT_EQ(BlameText(std::nullopt, runs.trace, runs.now, "/root"),
            "blame: unknown, this scenario has not agreed with its golden in this folder yet\n");
  EXPECT_EQ(BlameText(runs.last_agreed, std::nullopt, runs.now, "/root"),
            "blame: unknown, this scenario has not agreed with its golden in this folder yet\n");
}

}  // namespace
}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// The cause names the entity that moved differently, or says that none did, and the files that
// changed.
#include <gtest/gtest.h>

#include "harness/suite/check/causes.h"

namespace prehend::suite {
namespace {

struct Runs {
  LastPass last_pass{.program = "p",
                     .build = "GNU 12.2.0, x86_64, -O2",
                     .pictures = false,
                     .verdict = {.scenario = "slide/x"}};
  StateTrace trace{.entities = {"cup"}, .ticks = {0, 2}, .hashes = {1, 2}};
  DifferingRun now{.program = "p",
                   .build = "GNU 12.2.0, x86_64, -O2",
                   .inputs = {},
                   .trace = trace,
                   .ticks_per_second = 480};
  Runs() {
    last_pass.verdict.inputs = {{"/root/a.grammar", "1"}, {"/root/x.yaml", "2"}};
    now.inputs = last_pass.verdict.inputs;
  }
  std::string Text() const { return CauseText(last_pass, trace, now, "/root"); }
};

TEST(Cause, IsTheGrammarWhenEverythingMovesAsBefore) {
  Runs runs;
  runs.now.inputs["/root/a.grammar"] = "3";
  EXPECT_EQ(
      runs.Text(),
      "cause: the grammar or the golden. Everything moves as in the last passing run. Changed "
      "since: a.grammar\n");
}

TEST(Cause, IsThePhysicsFromTheFirstDivergence) {
  Runs runs;
  runs.now.trace.hashes[1] = 7;
  runs.now.program = "q";
  runs.now.inputs.erase("/root/x.yaml");
  runs.now.inputs["/elsewhere/y.yaml"] = "2";
  EXPECT_EQ(runs.Text(),
            "cause: physics. `cup` moves differently from the last passing run, first at 0.0042 s "
            "(tick 2). Changed since: /elsewhere/y.yaml, x.yaml, the program\n");
  runs.now.trace = {.entities = {"mug"}, .ticks = {0}, .hashes = {1}};
  EXPECT_TRUE(runs.Text().starts_with(
      "cause: physics. The entities are not those of the last passing run. Changed since: "))
      << runs.Text();
}

TEST(Cause, SaysHowAnotherProgramWasCompiled) {
  Runs runs;
  runs.now.program = "q";
  runs.now.build = "Clang 14.0.6, aarch64, -O3";
  EXPECT_TRUE(
      runs.Text().ends_with(" Changed since: the program (now Clang 14.0.6, aarch64, -O3; "
                            "then GNU 12.2.0, x86_64, -O2)\n"))
      << runs.Text();
  runs.last_pass.build = "";  // a record of before builds were kept
  EXPECT_TRUE(runs.Text().ends_with(" Changed since: the program\n")) << runs.Text();
}

TEST(Cause, WithoutAnyChangedFileNothingIsKnown) {
  Runs runs;
  runs.now.trace.ticks.pop_back();
  runs.now.trace.hashes.pop_back();
  EXPECT_EQ(runs.Text(),
            "cause: physics. Only one of this run and the last passing run reaches 0.0042 s (tick "
            "2). Changed since: no known file\n");
}

TEST(Cause, IsSensingWhenFramesAreAtOtherTicksOfTheSameMotion) {
  Runs runs;
  runs.trace = {.entities = {"cup"}, .ticks = {0, 2, 4, 6, 8, 10}, .hashes = {1, 2, 3, 4, 5, 6}};
  runs.now.trace = {.entities = {"cup"}, .ticks = {0, 4, 8}, .hashes = {1, 3, 5}};
  runs.now.options = {"--set world.sensing_hz=60"};
  EXPECT_EQ(runs.Text(),
            "cause: sensing. Frames are at other ticks than in the last passing run; where both "
            "have one, everything moves the same. Changed since: --set world.sensing_hz=60\n");
  runs.now.trace.hashes[1] = 7;
  EXPECT_TRUE(runs.Text().starts_with(
      "cause: physics. `cup` moves differently from the last passing run, first at 0.0083 s (tick "
      "4). "))
      << runs.Text();
  runs.now.trace = {.entities = {"cup"}, .ticks = {0, 4}, .hashes = {1, 3}};
  EXPECT_TRUE(runs.Text().starts_with(
      "cause: physics. Only one of this run and the last passing run reaches 0.0125 s (tick 6). "))
      << runs.Text();
}

TEST(Cause, AGrammarThatTheCommandLineChoseDidNotChange) {
  Runs runs;
  runs.now.inputs.erase("/root/a.grammar");
  runs.now.inputs["/root/b.grammar"] = "4";
  runs.now.options = {"--grammar b", "--set slide_min=2s"};
  runs.now.other_grammar = true;
  const std::string with_options = runs.Text();
  EXPECT_TRUE(with_options.ends_with(". Changed since: --grammar b, --set slide_min=2s\n"))
      << with_options;
  runs.now.options.clear();
  runs.now.other_grammar = false;
  EXPECT_TRUE(runs.Text().ends_with(". Changed since: b.grammar, a.grammar\n")) << runs.Text();
}

TEST(Cause, IsUnknownWithoutARunThatPassed) {
  const Runs runs;
  const std::string unknown =
      "cause: unknown. This scenario has not passed here yet. This program: GNU 12.2.0, x86_64, "
      "-O2.\n";
  EXPECT_EQ(CauseText(std::nullopt, runs.trace, runs.now, "/root"), unknown);
  EXPECT_EQ(CauseText(runs.last_pass, std::nullopt, runs.now, "/root"), unknown);
}

}  // namespace
}  // namespace prehend::suite

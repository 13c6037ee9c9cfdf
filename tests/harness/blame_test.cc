// SPDX-License-Identifier: Apache-2.0
// The blame names what moved otherwise, or says that nothing did, and which files changed.
#include "harness/blame.h"

#include <gtest/gtest.h>

namespace prehend::harness {
namespace {

struct Runs {
  CheckRecord last_pass{.program = "p", .pictures = false, .verdict = {.scenario = "slide/x"}};
  PhysicsTrace trace{.entities = {"cup"}, .ticks = {0, 2}, .hashes = {1, 2}};
  Suspect now{.program = "p", .inputs = {}, .trace = trace, .ticks_per_second = 480};
  Runs() {
    last_pass.verdict.inputs = {{"/root/a.grammar", "1"}, {"/root/x.yaml", "2"}};
    now.inputs = last_pass.verdict.inputs;
  }
  std::string Text() const { return BlameText(last_pass, trace, now, "/root"); }
};

TEST(Blame, IsTheGrammarsWhenEverythingMovesAsBefore) {
  Runs runs;
  runs.now.inputs["/root/a.grammar"] = "3";
  EXPECT_EQ(runs.Text(),
            "blame: the grammar or the golden: everything moves as when this last passed; changed "
            "since then: a.grammar\n");
}

TEST(Blame, IsThePhysicsFromWhereItParts) {
  Runs runs;
  runs.now.trace.hashes[1] = 7;
  runs.now.program = "q";
  runs.now.inputs.erase("/root/x.yaml");
  runs.now.inputs["/elsewhere/y.yaml"] = "2";
  EXPECT_EQ(runs.Text(),
            "blame: physics: since 0.0042 s (tick 2) cup does not move as when this last passed; "
            "changed since then: /elsewhere/y.yaml, x.yaml, the program\n");
  runs.now.trace = {.entities = {"mug"}, .ticks = {0}, .hashes = {1}};
  EXPECT_TRUE(runs.Text().starts_with("blame: physics: other entities; ")) << runs.Text();
}

TEST(Blame, WithoutAnyChangedFileItIsTheCommandLine) {
  Runs runs;
  runs.now.trace.ticks.pop_back();
  runs.now.trace.hashes.pop_back();
  EXPECT_EQ(runs.Text(),
            "blame: physics: since 0.0042 s (tick 2) the run is not as long as when this last "
            "passed; changed since then: no file, so it is the command line\n");
}

TEST(Blame, IsUnknownWithoutALastPass) {
  const Runs runs;
  EXPECT_EQ(BlameText(std::nullopt, runs.trace, runs.now, "/root"),
            "blame: unknown, this scenario has not passed in this folder yet\n");
  EXPECT_EQ(BlameText(runs.last_pass, std::nullopt, runs.now, "/root"),
            "blame: unknown, this scenario has not passed in this folder yet\n");
}

}  // namespace
}  // namespace prehend::harness

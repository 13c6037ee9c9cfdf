// SPDX-License-Identifier: Apache-2.0
// A verdict survives its way from the worker, and the worst one decides how a check ends.
#include "harness/suite/check/verdict.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace prehend::suite {
namespace {

/// The cup's slide ends `offset` ticks late, of 10 that it may; 1000 ticks a second.
truth::Comparison ComparedWith(grammar::Tick offset) {
  truth::Golden golden{.scenario = "slide/x", .grammar = "g", .ticks_per_second = 1000};
  grammar::NamedEvent event{.event = "sliding",
                            .roles = {{"hand", "hand"}, {"object", "cup"}, {"style", "wrap"}},
                            .interval = {100, 200},
                            .values = {{"force", 12.5, "N"}}};
  golden.events.push_back({.event = event, .tolerance_ms = {}, .because = {}, .comments = {}});
  event.interval.end += offset;
  return truth::Compare(golden, {.ticks_per_second = 1000, .events = {event}}, 10);
}

TEST(Verdict, TravelsWithAllItsFields) {
  const ScenarioVerdict verdict{.scenario = "slide/x",
                                .shows = "a \"slide\"",
                                .verdict = Verdict::kPending,
                                .exit_code = ExitCode::kPending,
                                .reason = "no golden yet",
                                .errors = {{.file = "a.yaml",
                                            .place = {2, 3},
                                            .message = "x",
                                            .source_line = "  x",
                                            .caret_column = 3,
                                            .hint = "y"}},
                                .details = "a\nb\n",
                                .notes = {"note: 1.0 s: hand: it has closed"},
                                .claims = {{.claim = "no sliding",
                                            .place = "x.yaml:4",
                                            .says = truth::kContradicted,
                                            .found = "found 1",
                                            .times = "  sliding\n"}},
                                .comparison = ComparedWith(50),
                                .has_golden = true,
                                .explain = "prehend explain slide/x",
                                .cause = "cause: physics\n",
                                .command = "prehend accept slide/x",
                                .state_hash = "0x1",
                                .ticks = 5,
                                .seconds = 0.25,
                                .peak_memory_kib = 9,
                                .inputs = {{"a.yaml", "0123"}},
                                .pictures = {{"p.png", "caption"}},
                                .picture_differences = "picture p.png\n"};
  const std::string packed = Packed(verdict).dump();
  const ScenarioVerdict unpacked = UnpackedVerdict(nlohmann::json::parse(packed));
  EXPECT_EQ(Packed(unpacked).dump(), packed);
  EXPECT_EQ(VerdictJson(unpacked), VerdictJson(verdict));
  EXPECT_EQ(DetailsText(unpacked), "a.yaml:2:3: error: x\n    x\n    ^\n  hint: y\na\nb\n");
  EXPECT_TRUE(unpacked.DiffersFromGolden());
  EXPECT_EQ(truth::DifferenceText(*unpacked.comparison, "x"),
            truth::DifferenceText(*verdict.comparison, "x"));
  EXPECT_FALSE(UnpackedVerdict(Packed(ScenarioVerdict{})).comparison);
  EXPECT_THROW(UnpackedVerdict(nlohmann::json::object()), nlohmann::json::exception);
}

TEST(Verdict, IsPrintedWithTheDocumentedKeys) {
  ScenarioVerdict verdict{.scenario = "slide/x", .shows = {}, .verdict = Verdict::kPassed};
  verdict.comparison = ComparedWith(4);
  verdict.has_golden = true;
  const auto json = VerdictJson(verdict);
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_EQ(keys,
            (std::vector<std::string>{
                "scenario",   "file",   "line",     "verdict",         "exit_code",   "reason",
                "details",    "errors", "notes",    "claims",          "differences", "relations",
                "blame",      "causes", "headroom", "boundaries",      "command",     "shows",
                "state_hash", "ticks",  "seconds",  "peak_memory_kib", "inputs",      "pictures"}));
  EXPECT_EQ(json["verdict"], "passed");
  EXPECT_EQ(json["headroom"], "margin: 6.0 of 10.0 ms left at end of sliding(hand, cup)");
  const nlohmann::ordered_json end_of_slide = {
      {"boundary", "end of sliding(hand, cup)"}, {"offset_ms", 4.0}, {"tolerance_ms", 10.0}};
  EXPECT_EQ(json["boundaries"][1], end_of_slide);
  verdict.claims = {{.claim = "no sliding",
                     .place = "x.yaml:4",
                     .says = truth::kContradicted,
                     .found = "found 1",
                     .times = {}}};
  const nlohmann::ordered_json claim = {{"claim", "no sliding"},
                                        {"place", "x.yaml:4"},
                                        {"verdict", "contradicted"},
                                        {"found", "found 1"}};
  EXPECT_EQ(VerdictJson(verdict)["claims"], nlohmann::ordered_json::array({claim}));
  verdict.comparison = ComparedWith(20);
  verdict.verdict = Verdict::kFailed;
  EXPECT_EQ(VerdictJson(verdict)["differences"].size(), 1u);
  EXPECT_EQ(VerdictJson(verdict)["headroom"], "") << "what failed has no margin";
  verdict.has_golden = false;
  EXPECT_EQ(VerdictJson(verdict)["differences"].size(), 0u) << "nothing to compare with";
  verdict.errors = {{.file = "x.yaml", .place = {4, 7}, .message = "expected a number"}};
  const nlohmann::ordered_json error = {{"file", "x.yaml"},
                                        {"line", 4},
                                        {"column", 7},
                                        {"message", "expected a number"},
                                        {"hint", ""}};
  EXPECT_EQ(VerdictJson(verdict)["errors"], nlohmann::ordered_json::array({error}));
  EXPECT_EQ(VerdictJson(verdict)["details"], "x.yaml:4:7: error: expected a number\n");
}

struct Case {
  std::vector<ExitCode> codes;
  ExitCode worst;
};

TEST(Verdict, TheWorstDecides) {
  const std::vector<Case> cases = {
      {{}, ExitCode::kNothing},
      {{ExitCode::kAgrees, ExitCode::kAgrees}, ExitCode::kAgrees},
      {{ExitCode::kAgrees, ExitCode::kPending}, ExitCode::kPending},
      {{ExitCode::kPending, ExitCode::kDiffers}, ExitCode::kDiffers},
      {{ExitCode::kBadInput, ExitCode::kDiffers}, ExitCode::kBadInput},
      {{ExitCode::kDiffers, ExitCode::kFailure, ExitCode::kBadInput}, ExitCode::kFailure},
  };
  for (const Case& row : cases) {
    std::vector<ScenarioVerdict> verdicts;
    for (const ExitCode code : row.codes) verdicts.push_back({.exit_code = code});
    EXPECT_EQ(WorstOf(verdicts), row.worst);
  }
}

TEST(Verdict, NotesArePrintedUntilItPasses) {
  ScenarioVerdict verdict{.exit_code = ExitCode::kPending, .notes = {"note: a", "note: b"}};
  EXPECT_EQ(NotesText(verdict), "note: a\nnote: b\n");
  verdict.exit_code = ExitCode::kAgrees;
  EXPECT_EQ(NotesText(verdict), "2 notes on its steps are in the report\n");
  verdict.notes.pop_back();
  EXPECT_EQ(NotesText(verdict), "1 note on its steps is in the report\n");
  verdict.notes.clear();
  EXPECT_EQ(NotesText(verdict), "");
}

TEST(Verdict, AreCounted) {
  const Tally tally = Count({{.verdict = Verdict::kPassed},
                             {.verdict = Verdict::kFailed},
                             {.verdict = Verdict::kPassed}});
  EXPECT_EQ(tally.passed, 2);
  EXPECT_EQ(tally.failed, 1);
  EXPECT_EQ(tally.pending, 0);
}

TEST(Verdict, TheSmallestMarginOfAllIsReported) {
  ScenarioVerdict exact{.scenario = "a/exact", .shows = {}}, near = exact, nearer = exact;
  EXPECT_EQ(SmallestMarginText({exact}), "");
  exact.has_golden = near.has_golden = nearer.has_golden = true;
  exact.comparison = ComparedWith(0);
  EXPECT_EQ(SmallestMarginText({exact}), "") << "an exact boundary needs no margin";
  near.comparison = ComparedWith(-2);
  nearer.scenario = "b/near";
  nearer.comparison = ComparedWith(5);
  EXPECT_EQ(SmallestMarginText({exact, near, nearer}),
            "smallest margin: 5.0 of 10.0 ms left at end of sliding(hand, cup) of b/near");
}

TEST(Verdict, RepeatsThatAgreeAreOneVerdict) {
  ScenarioVerdict run{.scenario = "a/b", .shows = {}, .verdict = Verdict::kPassed};
  run.state_hash = "0x1";
  std::vector<ScenarioVerdict> runs(3, run);
  runs[1].seconds = 2;
  runs[2].peak_memory_kib = 7;
  const ScenarioVerdict merged = MergeRepeats(runs);
  EXPECT_EQ(merged.verdict, Verdict::kPassed);
  EXPECT_EQ(merged.seconds, 2);
  EXPECT_EQ(merged.peak_memory_kib, 7);
}

TEST(Verdict, RepeatsThatDifferAreFlaky) {
  ScenarioVerdict run{.scenario = "a/b", .shows = {}, .verdict = Verdict::kPassed};
  run.state_hash = "0x1";
  std::vector<ScenarioVerdict> runs(3, run);
  runs[1].state_hash = "0x2";
  EXPECT_EQ(MergeRepeats(runs).verdict, Verdict::kFlaky);
  EXPECT_EQ(MergeRepeats(runs).exit_code, ExitCode::kDiffers);
  EXPECT_EQ(MergeRepeats(runs).reason, "flaky: of 3 runs 3 passed; 2 different state hashes");

  runs[1].verdict = Verdict::kFailed;
  runs[1].state_hash = "";
  runs[1].exit_code = ExitCode::kFailure;
  runs[1].details = "what the failed one said";
  EXPECT_EQ(MergeRepeats(runs).exit_code, ExitCode::kFailure);
  EXPECT_EQ(MergeRepeats(runs).reason, "flaky: of 3 runs 1 failed, 2 passed");
  EXPECT_EQ(MergeRepeats(runs).details, "what the failed one said");
  EXPECT_EQ(Count({MergeRepeats(runs)}).failed, 1);
}

TEST(Verdict, APictureThatDiffersFailsWithoutBeingFlaky) {
  std::vector<ScenarioVerdict> runs(2);
  for (ScenarioVerdict& run : runs) run.verdict = Verdict::kPassed;
  runs[1].picture_differences =
      "picture x.png: 5 % differ\n";  // the first of them to end drew nothing
  const ScenarioVerdict merged = MergeRepeats(runs);
  EXPECT_EQ(merged.verdict, Verdict::kFailed);
  EXPECT_EQ(merged.exit_code, ExitCode::kDiffers);
  EXPECT_EQ(merged.reason, "a picture differs from its golden");
  EXPECT_EQ(merged.details, "picture x.png: 5 % differ\n");
  runs[0].verdict = Verdict::kFailed;
  EXPECT_EQ(MergeRepeats(runs).verdict, Verdict::kFlaky);
  EXPECT_EQ(UnpackedVerdict(Packed(runs[1])).picture_differences, runs[1].picture_differences);
}

}  // namespace
}  // namespace prehend::suite

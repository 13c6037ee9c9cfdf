// SPDX-License-Identifier: Apache-2.0
// Scores as tables. Tested by tests/harness/measure/score/score_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "grammar/base/wording.h"
#include "harness/measure/score/score.h"

namespace prehend::measure {
namespace {

using Row = std::vector<std::string>;

constexpr double kMsPerS = 1000;

std::string Percent(double share) { return fmt::format("{:.1f}", 100 * share); }

/// "+12", "-3", and "0" without a sign.
std::string SignedMs(double seconds) {
  const long ms = std::lround(kMsPerS * seconds);
  return ms == 0 ? "0" : fmt::format("{:+}", ms);
}

/// "median/p95/max", all signed; the last two are by magnitude.
std::string Milliseconds(const BoundaryErrors& errors) {
  if (errors.seconds.empty()) return "-";
  return fmt::format("{}/{}/{}", SignedMs(errors.Median()),
                     SignedMs(errors.QuantileByMagnitude(0.95)),
                     SignedMs(errors.QuantileByMagnitude(1)));
}

Row Header(double collar_s) {
  return {"event",
          "true",
          "found",
          "C",
          "D",
          "F",
          "M",
          "FM",
          "I'",
          "begin ms",
          "end ms",
          "F1@10",
          "@25",
          "@50",
          "edit",
          "frames",
          fmt::format("F@{:.0f}ms", kMsPerS * collar_s),
          "late ms"};
}

Row RowOf(const EventScore& s) {
  const Ward& ward = s.ward;
  const auto count = [](int n) { return n == 0 ? std::string(".") : std::to_string(n); };
  return {s.event,
          std::to_string(s.truths),
          std::to_string(s.found),
          count(ward.correct),
          count(ward.deleted),
          count(ward.fragmented),
          count(ward.merged),
          count(ward.fragmented_and_merged),
          count(ward.inserted),
          Milliseconds(s.begin),
          Milliseconds(s.end),
          Percent(s.overlap_10.F1()),
          Percent(s.overlap_25.F1()),
          Percent(s.overlap_50.F1()),
          fmt::format("{:.1f}", s.edit),
          Percent(s.frames.Accuracy()),
          Percent(s.within_collar.AsHits().F1()),
          s.latency_s.empty()
              ? "-"
              : fmt::format("{:.0f}/{:.0f}/{:.0f}", kMsPerS * s.LatencyQuantile(0.5),
                            kMsPerS * s.LatencyQuantile(0.95), kMsPerS * s.LatencyQuantile(1))};
}

/// "mean": of the kinds of events above it.
Row RowOf(const MeanOfKinds& mean, std::size_t width) {
  Row row(width, "");
  row.front() = "mean";
  const std::size_t first = width - 7;  // F1@10
  row[first] = Percent(mean.f1_10);
  row[first + 1] = Percent(mean.f1_25);
  row[first + 2] = Percent(mean.f1_50);
  row[first + 3] = fmt::format("{:.1f}", mean.edit);
  row[first + 4] = Percent(mean.frame_accuracy);
  row[first + 5] = Percent(mean.collar_f);
  return row;
}

/// Columns two spaces apart; the first is aligned left, the others right.
std::string Aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += i == 0 ? fmt::format("{:<{}}", row[i], widths[i])
                     : fmt::format("  {:>{}}", row[i], widths[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

int TruthsOf(const Score& score, const std::string& event) {
  const auto row = std::ranges::find(score.events, event, &EventScore::event);
  return row == score.events.end() ? 0 : row->truths;
}

std::string NotCoveredText(const Score& score) {
  if (score.not_covered.empty()) return "";
  std::vector<std::string> kinds;
  for (const std::string& event : score.not_covered)
    kinds.push_back(fmt::format("{} ({} true)", event, TruthsOf(score, event)));
  return fmt::format(
      "not covered: {}; no rule of the grammar prints them, so they count as missed\n",
      fmt::join(kinds, ", "));
}

std::string IgnoredText(const Score& score) {
  if (score.ignored.empty()) return "";
  std::vector<std::string> kinds;
  for (const auto& [event, times] : score.ignored)
    kinds.push_back(fmt::format("{} ({} found)", event, times));
  return fmt::format("ignored: {}; {}\n", fmt::join(kinds, ", "), score.ignored_because);
}

std::string ProgramText(const Score& score) {
  std::string text;
  if (!score.failed.empty())
    text += fmt::format("failed, and in no figure: {}\n", fmt::join(score.failed, ", "));
  if (score.cpu_share > 0)
    text += fmt::format("{:.3f} s of processor time for a second\n", score.cpu_share);
  return text;
}

std::string MomentsText(const Score& score) {
  std::vector<std::string> kinds;
  for (const auto& [event, moments] : score.moments)
    kinds.push_back(fmt::format("{} {} of {}", event, moments.found, moments.marked));
  if (kinds.empty()) return "";
  return fmt::format(
      "labels of a moment, and so many lie in such an event; they are in no other figure: {}\n",
      fmt::join(kinds, ", "));
}

}  // namespace

std::string ScoreTable(const Score& score, double collar_s) {
  std::vector<Row> rows = {Header(collar_s)};
  for (const EventScore& event : score.events) rows.push_back(RowOf(event));
  rows.push_back(RowOf(score.total));
  if (score.events.size() > 1) rows.push_back(RowOf(score.mean, rows.front().size()));
  return fmt::format("{}, {}{}\n{}{}{}{}{}", score.grammar,
                     score.set.empty() ? "" : "set " + score.set + ", ",
                     grammar::CountOf(score.episodes, "episode"), Aligned(rows), MomentsText(score),
                     NotCoveredText(score), IgnoredText(score), ProgramText(score));
}

std::string SideBySide(const std::vector<Score>& scores, double collar_s) {
  std::string text = fmt::format(
      "| grammar | true events | not covered by the grammar | correct | deleted | fragmented | "
      "merged | inserted | "
      "begin, ms | end, ms | F1@10 | F1@25 | F1@50 "
      "| F1@50, mean of types | edit | frames % | F at {:.0f} ms "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      kMsPerS * collar_s);
  for (const Score& score : scores) {
    const EventScore& s = score.total;
    const Ward& ward = s.ward;
    int not_covered = 0;
    for (const std::string& event : score.not_covered) not_covered += TruthsOf(score, event);
    text += fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.1f} | {} | {} "
        "|\n",
        score.grammar, s.truths, not_covered, ward.correct, ward.deleted,
        ward.fragmented + ward.fragmented_and_merged, ward.merged, ward.inserted,
        Milliseconds(s.begin), Milliseconds(s.end), Percent(s.overlap_10.F1()),
        Percent(s.overlap_25.F1()), Percent(s.overlap_50.F1()), Percent(score.mean.f1_50), s.edit,
        Percent(s.frames.Accuracy()), Percent(s.within_collar.AsHits().F1()));
  }
  return text;
}

std::string ScoresText(const std::vector<Score>& scores, double collar_s) {
  std::string text;
  for (const Score& one : scores) text += ScoreTable(one, collar_s) + "\n";
  if (scores.size() > 1) text += SideBySide(scores, collar_s) + "\n";
  return text +
         "C correct, D deleted, F fragmented, M merged, FM both, I' inserted (Ward et al. 2011); "
         "boundary errors are\n"
         "found - true: median / 95th percentile / largest, the last two by magnitude; late: from "
         "an event's end to its\n"
         "decision, median / 95th percentile / largest; all: pooled, mean: of the kinds above. "
         "Every "
         "grammar is scored on\nthe same true events.\n";
}

}  // namespace prehend::measure

// SPDX-License-Identifier: Apache-2.0
// Scores as tables. Tested by tests/harness/measure/score/score_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "grammar/base/diagnostic.h"
#include "harness/measure/score/score.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::measure {
namespace {

using Row = std::vector<std::string>;

constexpr double kMsPerS = 1000;

std::string Percent(double share) { return fmt::format("{:.1f}", 100 * share); }

long Ms(double seconds) { return std::lround(kMsPerS * seconds); }

/// "+12", "-3", and "0" without a sign.
std::string SignedMs(double seconds) {
  const long ms = Ms(seconds);
  return ms == 0 ? "0" : fmt::format("{:+}", ms);
}

/// "median/p95/max", all signed; the last two are by magnitude.
std::string Milliseconds(const TimeErrors& errors) {
  if (errors.seconds.empty()) return "-";
  return fmt::format("{}/{}/{}", SignedMs(errors.Median()),
                     SignedMs(errors.QuantileByMagnitude(0.95)),
                     SignedMs(errors.QuantileByMagnitude(1)));
}

/// What the name of the column does not say.
std::string CollarsText(const Score& score) {
  if (score.total.collar_s >= 0) return "";
  std::string text;
  for (const EventScore& event : score.events)
    text += fmt::format("{}{} {:.0f} ms", text.empty() ? "F@collar: " : ", ", event.event,
                        kMsPerS * event.collar_s);
  return text + "\n";
}

Row Header(const Score& score) {
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
          score.total.collar_s >= 0 ? fmt::format("F@{:.0f}ms", kMsPerS * score.total.collar_s)
                                    : "F@collar",
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
          s.late.seconds.empty()
              ? "-"
              : fmt::format("{}/{}/{}", Ms(s.late.Median()), Ms(s.late.QuantileByMagnitude(0.95)),
                            Ms(s.late.QuantileByMagnitude(1)))};
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

// Tested by tests/program/score_test.cc

using Json = nlohmann::ordered_json;

/// Null where the table has "-", as are numbers that are none.
Json TimeJson(const TimeErrors& errors) {
  if (errors.seconds.empty()) return {{"median", nullptr}, {"p95", nullptr}, {"max", nullptr}};
  return {{"median", errors.Median()},
          {"p95", errors.QuantileByMagnitude(0.95)},
          {"max", errors.QuantileByMagnitude(1)}};
}

Json FurtherJson(const EventScore& s) {
  const FurtherScores& further = s.further;
  return {{"map_50", further.map_50},
          {"boundary_precision", further.boundary_hits.Precision()},
          {"boundary_recall", further.boundary_hits.Recall()},
          {"boundary_f1", further.boundary_hits.F1()},
          {"boundary_deviation_s",
           {{"from_truth", further.deviation_from_truth_s},
            {"from_found", further.deviation_from_found_s}}},
          {"pairwise_f1", further.pairwise_f1},
          {"purity", further.purity},
          {"coverage", further.coverage},
          {"frame_f1", s.frames.F1()},
          {"detection_error_rate", s.frames.DetectionErrorRate()},
          {"intersection_f1", further.intersection_f1},
          {"psds", further.psds}};
}

/// Null, if it is of kinds with several.
Json CollarJson(double collar_s) { return collar_s >= 0 ? Json(collar_s) : Json(); }

Json EventScoreJson(const EventScore& s) {
  const Ward& ward = s.ward;
  return {{"event", s.event},
          {"true", s.truths},
          {"found", s.found},
          {"ward",
           {{"correct", ward.correct},
            {"deleted", ward.deleted},
            {"fragmented", ward.fragmented},
            {"merged", ward.merged},
            {"fragmented_and_merged", ward.fragmented_and_merged},
            {"inserted", ward.inserted},
            {"found",
             {{"correct", ward.found_correct},
              {"fragmenting", ward.fragmenting},
              {"merging", ward.merging},
              {"fragmenting_and_merging", ward.fragmenting_and_merging}}},
            {"missed_s",
             {{"deletion", ward.missed.alone},
              {"fragmentation", ward.missed.between},
              {"underfill_begin", ward.missed.before},
              {"underfill_end", ward.missed.after}}},
            {"false_s",
             {{"insertion", ward.false_alarm.alone},
              {"merge", ward.false_alarm.between},
              {"overfill_begin", ward.false_alarm.before},
              {"overfill_end", ward.false_alarm.after}}}}},
          {"begin_s", TimeJson(s.begin)},
          {"end_s", TimeJson(s.end)},
          {"f1_10", s.overlap_10.F1()},
          {"f1_25", s.overlap_25.F1()},
          {"f1_50", s.overlap_50.F1()},
          {"edit", s.edit},
          {"frame_accuracy", s.frames.Accuracy()},
          {"kappa", s.frames.Kappa()},
          {"collar_s", CollarJson(s.collar_s)},
          {"collar_f", s.within_collar.AsHits().F1()},
          {"collar_error_rate", s.within_collar.ErrorRate()},
          {"latency_s", TimeJson(s.late)},
          {"further", FurtherJson(s)}};
}

Json MomentsJson(const Score& score) {
  Json moments = Json::object();
  for (const auto& [event, one] : score.moments)
    moments[event] = {{"true", one.marked}, {"found", one.found}};
  return moments;
}

Json HitsJson(const Hits& hits) {
  return {{"correct", hits.correct}, {"extra", hits.extra}, {"missed", hits.missed}};
}

/// What was compared; true events with their bands, if they have any.
Json ComparedJson(const EpisodeRow& row) {
  Json truth = truth::TimelineJson(row.truth);
  for (std::size_t i = 0; i < row.bands.size(); ++i) {
    truth["events"][i]["begin_band_tick"] = {row.bands[i].begin.begin, row.bands[i].begin.end};
    truth["events"][i]["end_band_tick"] = {row.bands[i].end.begin, row.bands[i].end.end};
  }
  return {{"end_tick", row.ticks},
          {"truth_events", std::move(truth)},
          {"found_events", truth::TimelineJson(row.found)}};
}

Json RowsJson(const std::vector<EpisodeRow>& episodes, bool with_events) {
  Json rows = Json::array();
  for (const EpisodeRow& row : episodes) {
    const EventScore& s = row.total;
    Json by_event = Json::object();
    for (const auto& [event, hits] : row.hits) by_event[event] = HitsJson(hits);
    rows.push_back({{"episode", row.episode},
                    {"person", row.person},
                    {"set", row.set},
                    {"true", s.truths},
                    {"found", s.found},
                    {"f1_10", s.overlap_10.F1()},
                    {"f1_25", s.overlap_25.F1()},
                    {"f1_50", s.overlap_50.F1()},
                    {"edit", s.edit},
                    {"frame_accuracy", s.frames.Accuracy()},
                    {"collar_f", s.within_collar.AsHits().F1()},
                    {"hits_50", HitsJson(s.overlap_50)},
                    {"hits_50_of", std::move(by_event)}});
    if (with_events) rows.back().update(ComparedJson(row));
  }
  return rows;
}

Json MeanJson(const MeanOfKinds& mean) {
  return {{"f1_10", mean.f1_10},
          {"f1_25", mean.f1_25},
          {"f1_50", mean.f1_50},
          {"edit", mean.edit},
          {"frame_accuracy", mean.frame_accuracy},
          {"collar_f", mean.collar_f}};
}

}  // namespace

std::string ScoreTable(const Score& score) {
  std::vector<Row> rows = {Header(score)};
  for (const EventScore& event : score.events) rows.push_back(RowOf(event));
  rows.push_back(RowOf(score.total));
  if (score.events.size() > 1) rows.push_back(RowOf(score.mean, rows.front().size()));
  return fmt::format(
      "{}, {}{}\n{}{}{}{}{}{}", score.grammar, score.set.empty() ? "" : "set " + score.set + ", ",
      grammar::CountOf(score.episodes, "episode"),
      truth::AlignColumns(rows, truth::Numbers::kRight), CollarsText(score), MomentsText(score),
      NotCoveredText(score), IgnoredText(score), ProgramText(score));
}

std::string SideBySide(const std::vector<Score>& scores) {
  std::string text = fmt::format(
      "| grammar | true events | not covered by the grammar | correct | deleted | fragmented | "
      "merged | inserted | begin, ms | end, ms | F1@10 | F1@25 | F1@50 | F1@50, mean of types | "
      "edit | frames % | F at {} "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      scores.front().total.collar_s >= 0
          ? fmt::format("{:.0f} ms", kMsPerS * scores.front().total.collar_s)
          : "its collar");
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

std::string ScoresText(const std::vector<Score>& scores) {
  std::string text;
  for (const Score& one : scores) text += ScoreTable(one) + "\n";
  if (scores.size() > 1) text += SideBySide(scores) + "\n";
  return text +
         "C correct, D deleted, F fragmented, M merged, FM both, I' inserted (Ward et al. 2011); "
         "boundary errors are\n"
         "found - true: median / 95th percentile / largest, the last two by magnitude; late: from "
         "an event's end to its\n"
         "decision, median / 95th percentile / largest; all: pooled, mean: of the kinds above. "
         "Every grammar is scored on\nthe same true events.\n";
}

Json ScoresJson(const std::vector<Score>& scores, bool with_events) {
  Json grammars = Json::array();
  for (const Score& s : scores) {
    Json events = Json::array();
    for (const EventScore& event : s.events) events.push_back(EventScoreJson(event));
    grammars.push_back({{"grammar", s.grammar},
                        {"set", s.set},
                        {"episodes", s.episodes},
                        {"not_covered", s.not_covered},
                        {"ignored", s.ignored},
                        {"failed", s.failed},
                        {"cpu_s_per_s", s.cpu_share},
                        {"moments", MomentsJson(s)},
                        {"total", EventScoreJson(s.total)},
                        {"mean_of_events", MeanJson(s.mean)},
                        {"events", std::move(events)},
                        {"rows", RowsJson(s.rows, with_events)}});
  }
  return {{"collar_s", CollarJson(scores.empty() ? 0 : scores.front().total.collar_s)},
          {"grammars", std::move(grammars)}};
}

Json EvaluationJson(const Evaluation& evaluation) {
  Json by_event = Json::object();
  for (const auto& [event, count] : evaluation.by_event)
    by_event[event] = {{"of", count.of}, {"confirmed", count.confirmed}};
  return {{"by_event", std::move(by_event)}, {"differences", evaluation.differences}};
}

Json EvaluatorsJson(const std::vector<Score>& scores, const std::vector<Evaluator>& evaluators) {
  Json rows = Json::array();
  for (const Evaluator& evaluator : evaluators) {
    Json columns = Json::array();
    for (std::size_t g = 0; g < scores.size(); ++g) {
      const Confirmed total = evaluator.of_grammars[g].Total();
      Json column = {
          {"grammar", scores[g].grammar}, {"of", total.of}, {"confirmed", total.confirmed}};
      column.update(EvaluationJson(evaluator.of_grammars[g]));
      columns.push_back(std::move(column));
    }
    rows.push_back({{"witness", evaluator.name},
                    {"proves", evaluator.proves},
                    {"grammars", std::move(columns)}});
  }
  return rows;
}

}  // namespace prehend::measure

// SPDX-License-Identifier: Apache-2.0
// Tested by tests/program/score_test.cc
#include <nlohmann/json.hpp>

#include "harness/measure/score/score.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::measure {
namespace {

using Json = nlohmann::ordered_json;

Json BoundaryJson(const BoundaryErrors& errors) {
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
          {"begin_s", BoundaryJson(s.begin)},
          {"end_s", BoundaryJson(s.end)},
          {"f1_10", s.overlap_10.F1()},
          {"f1_25", s.overlap_25.F1()},
          {"f1_50", s.overlap_50.F1()},
          {"edit", s.edit},
          {"frame_accuracy", s.frames.Accuracy()},
          {"kappa", s.frames.Kappa()},
          {"collar_f", s.within_collar.AsHits().F1()},
          {"collar_error_rate", s.within_collar.ErrorRate()},
          {"latency_s",
           {{"median", s.LatencyQuantile(0.5)},
            {"p95", s.LatencyQuantile(0.95)},
            {"max", s.LatencyQuantile(1)}}},
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

Json ScoresJson(const std::vector<Score>& scores, double collar_s, bool with_events) {
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
  return {{"collar_s", collar_s}, {"grammars", std::move(grammars)}};
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

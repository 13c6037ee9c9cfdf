// SPDX-License-Identifier: Apache-2.0
// The page that compares labels, grammars and others. See harness/cli/daily/report_labels.h. Tested
// by tests/program/report_labels_test.cc
#include "harness/cli/daily/report_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include "harness/suite/check/check_request.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

namespace fs = std::filesystem;
using measure::EpisodeToScore;
using truth::LineVerdict;

/// How an event ends and what was measured in it is no matter of labels.
grammar::NamedEvent Plain(grammar::NamedEvent event) {
  event.open_end = false;
  event.values.clear();
  return event;
}

truth::Comparison Compared(const EpisodeToScore& take, const measure::LabelScores& scores,
                           double collar_s) {
  truth::Golden labels{.ticks_per_second = take.truth.ticks_per_second};
  for (const grammar::NamedEvent& event : take.truth.events) {
    truth::GoldenEvent line{.event = Plain(event)};
    if (const auto own = scores.collars_s.find(event.event); own != scores.collars_s.end())
      line.tolerance_ms = static_cast<int>(std::lround(1000 * own->second));
    labels.events.push_back(std::move(line));
  }
  grammar::Timeline found = take.found;
  std::ranges::transform(found.events, found.events.begin(), Plain);
  return truth::Compare(labels, found, truth::TickAt(collar_s, found.ticks_per_second));
}

/// What a page that lies there calls a file.
std::string UrlFrom(const std::string& page, const std::string& file) {
  const fs::path folder = fs::absolute(page).parent_path();
  std::string url;
  for (const char c : fs::absolute(file).lexically_normal().lexically_proximate(folder).string()) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) || std::strchr("/._-~", c);
    url += is_plain ? std::string(1, c)
                    : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return url;
}

/// Which event was found in the place of which.
suite::ReportTable ConfusionOf(const std::string& first, const std::string& side,
                               const std::vector<truth::Comparison>& comparisons) {
  constexpr const char* kNothing = "nothing";
  std::map<std::string, std::map<std::string, int>> counts;
  std::map<std::string, int> columns;
  for (const truth::Comparison& comparison : comparisons) {
    for (const truth::Pairing& pairing : comparison.pairings) {
      if (pairing.IsFurtherPiece()) continue;
      const bool has_other_roles = pairing.agreement == LineVerdict::kChanged;
      const std::string found =
          pairing.actual ? pairing.actual->event + (has_other_roles ? " of others" : "") : kNothing;
      ++counts[pairing.expected ? pairing.expected->event : kNothing][found];
      ++columns[found];
    }
  }
  suite::ReportTable table{.title =
                               fmt::format("Rows: {}; columns: what {} has there", first, side)};
  std::vector<std::string>& head = table.rows.emplace_back(1, "");
  for (const auto& [found, _] : columns) head.push_back(found);
  for (auto& [event, row] : counts) {
    std::vector<std::string>& cells = table.rows.emplace_back(1, event);
    for (const auto& [found, _] : columns)
      cells.push_back(row.contains(found) ? std::to_string(row[found]) : "");
  }
  return table;
}

suite::ReportTable AgreementOf(const std::string& first, const measure::Score& score) {
  suite::ReportTable table{
      .title = fmt::format("{}{}, against {}", score.grammar,
                           score.set.empty() ? "" : ", set " + score.set, first),
      .rows = {{"", first, "found", "F1@50, %", "begin, ms", "end, ms"}}};
  const auto add = [&](const measure::EventScore& event) {
    const auto median = [](const measure::BoundaryErrors& errors) {
      return errors.seconds.empty() ? "" : fmt::format("{:+.0f}", 1000 * errors.Median());
    };
    table.rows.push_back({event.event, std::to_string(event.truths), std::to_string(event.found),
                          fmt::format("{:.1f}", 100 * event.overlap_50.F1()), median(event.begin),
                          median(event.end)});
  };
  for (const measure::EventScore& event : score.events) add(event);
  add(score.total);
  return table;
}

/// Adds what one side says of a take to its verdict.
void Add(truth::Comparison comparison, const std::string& side, bool is_only,
         suite::ScenarioVerdict& verdict) {
  const bool is_first = !verdict.has_golden;
  for (suite::Attribution one : suite::AttributeDifferences(comparison, {}, {})) {
    one.because = (is_only ? "" : side + ": ") + one.event;
    verdict.attributions.push_back(std::move(one));
  }
  if (!comparison.Agrees()) {
    verdict.verdict = suite::Verdict::kFailed;
    verdict.exit_code = ExitCode::kDiffers;
    verdict.reason += fmt::format("{}{}{} of {} events differ", verdict.reason.empty() ? "" : "; ",
                                  is_only ? "" : side + ": ", comparison.Differing().size(),
                                  comparison.pairings.size());
    verdict.details +=
        (is_only ? "" : side + ":\n") + truth::DifferenceText(comparison, verdict.explain);
  }
  verdict.has_golden = true;
  if (is_first)
    verdict.comparison = std::move(comparison);
  else
    verdict.labelled.others.push_back(std::move(comparison));
}

/// The share of events that differ.
double Differing(const suite::ScenarioVerdict& verdict) {
  double differing = 0, all = 1e-9;
  const auto count = [&](const truth::Comparison& comparison) {
    differing += static_cast<double>(comparison.Differing().size());
    all += static_cast<double>(comparison.pairings.size());
  };
  if (verdict.has_golden) count(*verdict.comparison);
  std::ranges::for_each(verdict.labelled.others, count);
  return differing / all;
}

}  // namespace

suite::ReportHeader CompareSides(const measure::LabelScores& scores, const std::string& first,
                                 double collar_s, const std::string& page,
                                 std::vector<suite::ScenarioVerdict>& verdicts,
                                 std::string& warnings) {
  suite::ReportHeader header{.title = "Comparison with " + first, .sides = {first}};
  for (suite::ScenarioVerdict& verdict : verdicts) {
    if (verdict.exit_code == ExitCode::kBadInput) continue;
    verdict.verdict = suite::Verdict::kPassed;
    verdict.exit_code = ExitCode::kAgrees;
    verdict.has_golden = false;
    verdict.reason = verdict.details = "";
    verdict.attributions.clear();
    verdict.explained = {};
    verdict.command = suite::CommandAbout("explain", verdict.file);
    verdict.explain = verdict.command;
  }
  for (const measure::Score& score : scores.of_grammars)
    header.tables.push_back(AgreementOf(first, score));
  for (const measure::Opinion& opinion : scores.opinions) {
    header.sides.push_back(opinion.name);
    std::vector<truth::Comparison> comparisons;
    for (const EpisodeToScore& take : opinion.takes) {
      suite::ScenarioVerdict& verdict = verdicts[take.take];
      if (verdict.exit_code == ExitCode::kBadInput) continue;
      comparisons.push_back(Compared(take, scores, collar_s));
      if (!verdict.has_golden)
        for (const auto& [event, moments] : take.moments)
          verdict.labelled.moments.insert(verdict.labelled.moments.end(), moments.labels.begin(),
                                          moments.labels.end());
      Add(comparisons.back(), opinion.name, scores.opinions.size() == 1, verdict);
      if (!take.failure.empty())
        verdict.notes.push_back(opinion.name + " has failed here: " + take.failure);
      if (take.video.empty() || !verdict.labelled.video.empty()) continue;
      std::error_code error;
      if (!fs::is_regular_file(take.video, error))
        warnings += fmt::format("warning: no video {} of {}\n", take.video, take.scenario);
      else
        verdict.labelled.video = UrlFrom(page, take.video);
      // Dates of labels say nothing of a video.
      if (std::abs(take.offset_s) < 1e8) verdict.labelled.offset_s = take.offset_s;
    }
    header.tables.push_back(ConfusionOf(first, opinion.name, comparisons));
  }
  header.scores = measure::LabelScoresText(scores, collar_s, true);
  std::ranges::stable_sort(verdicts, std::greater{}, Differing);
  return header;
}

}  // namespace prehend::cli

// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/compare_with_oracle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <set>

#include "grammar/contents.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/oracle/oracle.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

bool IsWithin(const truth::Match& match, grammar::Tick tolerance) {
  return std::max(std::abs(match.begin_offset()), std::abs(match.end_offset())) <= tolerance;
}

/// "begins 29.2 ms earlier than recognised": a recognised boundary that is late is earlier in
/// truth.
std::string BoundaryText(const char* verb, double late_ms) {
  return fmt::format("{} {:.1f} ms {} than recognised", verb, std::abs(late_ms),
                     late_ms > 0 ? "earlier" : "later");
}

std::string OffsetText(const truth::Match& match, grammar::Tick ticks_per_second) {
  const double begin_ms = truth::MillisecondsOf(match.begin_offset(), ticks_per_second),
               end_ms = truth::MillisecondsOf(match.end_offset(), ticks_per_second);
  if (end_ms == 0) return BoundaryText("begins", begin_ms) + "; its end agrees";
  if (begin_ms == 0) return BoundaryText("ends", end_ms) + "; its begin agrees";
  return BoundaryText("begins", begin_ms) + " and " + BoundaryText("ends", end_ms);
}

}  // namespace

int OracleComparison::Following() const {
  int following = 0;
  for (const truth::LabelAgreement& label : agreement.labels)
    following += static_cast<int>(std::ranges::count_if(
        label.matches, [&](const truth::Match& match) { return IsWithin(match, tolerance); }));
  return following;
}

int OracleComparison::Differing() const { return judged - Following() + agreement.missing(); }

OracleComparison CompareWithOracle(const scenario::Scenario& scenario,
                                   const grammar::Program& program, const episode::RunResult& run) {
  std::vector<grammar::Timeline> possible =
      truth::PossibleTimelines(scenario.scene, run.recording, run.ticks + 1);
  grammar::Timeline found = run.timeline;
  // A grammar is not judged by events that it has no rules for.
  std::set<std::string> judged;
  for (const grammar::EventSignature& event : EventSignatures(program))
    if (truth::OracleDefines(event.name, event.roles.empty() ? "" : event.roles.front()))
      judged.insert(event.name);
  const auto is_other = [&](const auto& event) { return !judged.contains(event.event); };
  std::erase_if(found.events, is_other);
  for (grammar::Timeline& truth : possible) std::erase_if(truth.events, is_other);
  const grammar::Tick tolerance = scenario::DefaultTolerance(scenario);
  const std::size_t others = run.timeline.events.size() - found.events.size();
  return {.agreement = truth::AgreeWithin(possible, found, tolerance),
          .tolerance = tolerance,
          .judged = static_cast<int>(found.events.size()),
          .not_judged = static_cast<int>(others)};
}

std::string OracleLine(const OracleComparison& compared) {
  const truth::Agreement& agreement = compared.agreement;
  const int elsewhere = agreement.matched() - compared.Following();
  const double off_ms =
      truth::MillisecondsOf(agreement.largest_offset(), agreement.ticks_per_second);
  const std::string boundaries =
      elsewhere == 0
          ? ""
          : fmt::format("; {} more begin{} or end{} up to {:.1f} ms elsewhere", elsewhere,
                        elsewhere == 1 ? "s" : "", elsewhere == 1 ? "s" : "", off_ms);
  const std::string not_recognised =
      agreement.missing() == 0
          ? ""
          : fmt::format("; {} that follow are not recognised", agreement.missing());
  const std::string not_judged =
      compared.not_judged == 0
          ? ""
          : fmt::format(" ({} events of other kinds not judged)", compared.not_judged);
  return fmt::format("{}{} of {} events follow from the definitions of docs/events.md{}{}{}",
                     kOracleLine, compared.Following(), compared.judged, boundaries, not_recognised,
                     not_judged);
}

std::string GroundTruthText(const OracleComparison& compared) {
  const grammar::Tick ticks_per_second = compared.agreement.ticks_per_second;
  const auto when = [&](const grammar::NamedEvent& event) {
    return truth::IntervalText(event.interval, ticks_per_second);
  };
  std::string text;
  for (const truth::LabelAgreement& label : compared.agreement.labels) {
    for (const truth::Match& match : label.matches) {
      if (IsWithin(match, compared.tolerance)) continue;
      text += fmt::format("ground truth: {} {} (recognised {})\n", label.label,
                          OffsetText(match, ticks_per_second), when(match.found));
    }
    for (const grammar::NamedEvent& event : label.extra)
      text += fmt::format("ground truth: no {}, recognised {}\n", label.label, when(event));
    for (const grammar::NamedEvent& event : label.missing)
      text += fmt::format("ground truth: {} {}, not recognised\n", label.label, when(event));
  }
  return text;
}

std::string DifferingText(int differing) {
  return fmt::format("{} event{} from the ground truth",
                     differing == 0 ? "no" : std::to_string(differing),
                     differing > 1 ? "s differ" : " differs");
}

int AcceptedDiffering(const std::vector<std::string>& derived) {
  const auto line = std::ranges::find_if(
      derived, [](const std::string& text) { return text.starts_with(kOracleLine); });
  if (line == derived.end()) return 0;
  static const std::regex kCounts(
      "oracle: (\\d{1,9}) of (\\d{1,9}) events follow"
      "(?:.*; (\\d{1,9}) that follow are not recognised)?.*");
  std::smatch counts;
  if (!std::regex_match(*line, counts, kCounts)) return 0;
  const int not_recognised = counts[3].matched ? std::stoi(counts[3]) : 0;
  return std::stoi(counts[2]) - std::stoi(counts[1]) + not_recognised;
}

std::vector<std::string> RenewedDerivation(const std::vector<std::string>& lines,
                                           const std::string& oracle_line) {
  std::vector<std::string> renewed;
  std::ranges::copy_if(lines, std::back_inserter(renewed),
                       [](const auto& line) { return !line.starts_with(kOracleLine); });
  renewed.push_back(oracle_line);
  return renewed;
}

}  // namespace prehend::suite

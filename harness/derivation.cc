// SPDX-License-Identifier: Apache-2.0
#include "harness/derivation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "grammar/contents.h"
#include "harness/compare.h"
#include "harness/event_text.h"
#include "harness/golden.h"
#include "harness/oracle/agreement.h"
#include "harness/oracle/oracle.h"

namespace prehend::harness {

Judged JudgedByOracle(const Scenario& scenario, const grammar::Program& program,
                      const RunResult& run) {
  Judged judged{.truth = TrueTimeline(scenario, run.recording, run.ticks + 1),
                .found = run.timeline};
  std::erase_if(judged.found.events, [](const auto& event) { return !OracleDefines(event.event); });
  // A grammar is not blamed for events that it does not speak of.
  std::erase_if(judged.truth.events,
                [&](const auto& event) { return !HasEvent(program, event.event); });
  return judged;
}

namespace {

std::vector<OracleNote> NotesOf(const Agreement& agreement, grammar::Tick tolerance,
                                const RunResult& run) {
  std::vector<OracleNote> notes;
  const auto offset_ms = [&](grammar::Tick ticks) {
    return MillisecondsOf(ticks, run.timeline.ticks_per_second);
  };
  for (const LabelAgreement& label : agreement.labels) {
    for (const Match& match : label.matches) {
      if (std::max(std::abs(match.begin_offset()), std::abs(match.end_offset())) <= tolerance)
        continue;
      notes.push_back(
          {match.found, fmt::format("{:+.1f}/{:+.1f}ms", offset_ms(match.begin_offset()),
                                    offset_ms(match.end_offset()))});
    }
    for (const grammar::NamedEvent& event : label.extra) notes.push_back({event, kNotOfOracle});
    for (const grammar::NamedEvent& event : label.missing) notes.push_back({event, kOnlyOracle});
  }
  return notes;
}

}  // namespace

Derivation Derive(const Scenario& scenario, const grammar::Program& program, const RunResult& run) {
  const auto [truth, judged] = JudgedByOracle(scenario, program, run);
  const std::size_t others = run.timeline.events.size() - judged.events.size();
  const grammar::Tick tolerance =
      DefaultTolerance(scenario.world.rate_hz, scenario.world.sensing_hz);
  const Agreement agreement = Agree(truth, judged, tolerance);

  Derivation derivation{.agrees = agreement.Within(tolerance),
                        .lines = {},
                        .notes = NotesOf(agreement, tolerance, run),
                        .tolerance = tolerance};
  const std::string unjudged =
      others == 0 ? "" : fmt::format(" ({} events of other kinds not judged)", others);
  const std::string unseen =
      agreement.missing() == 0
          ? ""
          : fmt::format("; {} that follow are not recognised", agreement.missing());
  const auto elsewhere = std::ranges::count_if(derivation.notes, [](const OracleNote& note) {
    return note.text != kNotOfOracle && note.text != kOnlyOracle;
  });
  const double off_ms = MillisecondsOf(agreement.largest_offset(), agreement.ticks_per_second);
  const std::string boundaries =
      elsewhere == 0
          ? fmt::format(", boundaries at most {:.1f} ms off", off_ms)
          : fmt::format("; {} more begin{} or end{} up to {:.1f} ms elsewhere", elsewhere,
                        elsewhere == 1 ? "s" : "", elsewhere == 1 ? "s" : "", off_ms);
  derivation.lines.push_back(fmt::format(
      "{}{} of {} events follow from the definitions of docs/events.md{}{}{}", kOracleLine,
      agreement.matched() - elsewhere, judged.events.size(), boundaries, unseen, unjudged));
  return derivation;
}

std::vector<std::string> RenewedDerivation(const std::vector<std::string>& lines,
                                           const Derivation& derivation) {
  std::vector<std::string> renewed;
  std::ranges::copy_if(lines, std::back_inserter(renewed),
                       [](const auto& line) { return !line.starts_with(kOracleLine); });
  renewed.insert(renewed.end(), derivation.lines.begin(), derivation.lines.end());
  return renewed;
}

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// See accept_golden.h. Tested by tests/harness/accept_golden_test.cc
#include "harness/accept_golden.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/compare.h"
#include "harness/content_hash.h"
#include "harness/event_text.h"

namespace prehend::harness {
namespace {

using Lines = std::vector<std::string>;

bool IsExactly(const Pairing& pairing) {
  return pairing.agreement == LineVerdict::kMatched && pairing.begin_offset == 0 &&
         pairing.end_offset == 0;
}

/// With the digits that a golden keeps.
double AsWritten(double value) { return std::stod(fmt::format("{:.4g}", value)); }

void Append(Lines& to, const Lines& lines) { to.insert(to.end(), lines.begin(), lines.end()); }

/// What people wrote above an event that is gone.
Lines Farewell(const GoldenEvent& gone, grammar::Tick ticks_per_second) {
  if (gone.comments.empty()) return {};
  Lines lines = {fmt::format("was above {} {}, which is gone:", gone.event.Label(),
                             IntervalText(gone.event.interval, ticks_per_second))};
  Append(lines, gone.comments);
  return lines;
}

/// What its partner in the old golden had; where nothing changed, the acceptance it is from, too.
void Inherit(GoldenEvent& line, const GoldenEvent& old, bool exactly) {
  if (exactly) line.accepted = old.accepted;
  line.tolerance_ms = old.tolerance_ms;
  line.because = old.because;
  line.oracle = old.oracle;
  line.oracle_because = old.oracle_because;
  line.comments = old.comments;
}

/// The events of the comparison's actual side, in order of time; each inherits from its partner.
void TakeOver(Golden& golden, const Golden& old, const grammar::Timeline& recognised) {
  for (const Pairing& pairing : Compare(old, recognised, 0).pairings) {
    const GoldenEvent* partner = pairing.expected ? &old.events[pairing.golden_line] : nullptr;
    if (!pairing.actual) {
      if (partner) Append(golden.closing_comments, Farewell(*partner, old.ticks_per_second));
      continue;
    }
    GoldenEvent line;
    line.event = *pairing.actual;
    line.accepted = static_cast<int>(old.accepted.size()) + 1;
    if (partner) Inherit(line, *partner, IsExactly(pairing));
    golden.events.push_back(std::move(line));
  }
}

/// What the oracle says now.
void NoteOracle(Golden& golden, const Proposal& proposal) {
  for (GoldenEvent& line : golden.events) {
    const auto note = std::ranges::find_if(proposal.notes, [&](const OracleNote& candidate) {
      return candidate.event.interval == line.event.interval &&
             candidate.event.Label() == line.event.Label();
    });
    line.oracle = note == proposal.notes.end() ? "" : note->text;
    if (line.oracle.empty()) line.oracle_because.clear();
    if (!line.oracle.empty() && line.oracle_because.empty())
      line.oracle_because = proposal.acceptance->reason;
  }
}

}  // namespace

Golden ProposeGolden(const std::optional<Golden>& old, const grammar::Timeline& recognised,
                     const Proposal& proposal) {
  Golden golden{.scenario = proposal.scenario, .grammar = proposal.grammar};
  golden.ticks_per_second = recognised.ticks_per_second;
  if (old) {
    golden.derived = old->derived;
    golden.accepted = old->accepted;
    golden.pictures = old->pictures;
    golden.comments = old->comments;
    golden.closing_comments = old->closing_comments;
  }
  if (!proposal.derived.empty()) golden.derived = proposal.derived;
  if (proposal.acceptance) golden.accepted.push_back(*proposal.acceptance);
  TakeOver(golden, old.value_or(Golden{.ticks_per_second = recognised.ticks_per_second}),
           recognised);
  if (proposal.acceptance) NoteOracle(golden, proposal);
  for (GoldenEvent& line : golden.events) {
    line.event.decided = 0;
    for (grammar::NamedValue& value : line.event.values) value.value = AsWritten(value.value);
  }
  std::stable_sort(
      golden.events.begin(), golden.events.end(),
      [](const GoldenEvent& a, const GoldenEvent& b) { return ComesBefore(a.event, b.event); });
  return golden;
}

Golden PendingGolden(const std::optional<Golden>& old, const grammar::Timeline& recognised,
                     const std::string& scenario, const std::string& grammar) {
  Proposal proposal;
  proposal.scenario = scenario;
  proposal.grammar = grammar;
  return ProposeGolden(old, recognised, proposal);
}

std::string Fingerprint(const Golden& pending) {
  return ContentHash(WriteGolden(pending)).substr(0, 8);
}

bool SaysTheSame(const Golden& golden, const grammar::Timeline& recognised) {
  if (golden.ticks_per_second != recognised.ticks_per_second) return false;
  const Comparison comparison = Compare(golden, recognised, 0);
  return std::ranges::all_of(comparison.pairings, IsExactly);
}

}  // namespace prehend::harness

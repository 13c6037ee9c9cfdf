// SPDX-License-Identifier: Apache-2.0
// See accept_golden.h. Tested by tests/harness/accept_golden_test.cc
#include "harness/accept_golden.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/compare.h"
#include "harness/event_text.h"

namespace prehend::harness {
namespace {

using Lines = std::vector<std::string>;

void MoveTo(Lines& to, Lines& from) {
  to.insert(to.end(), from.begin(), from.end());
  from.clear();
}

bool IsExactly(const Pairing& pairing) {
  return pairing.agreement == LineVerdict::kMatched && pairing.begin_offset == 0 &&
         pairing.end_offset == 0;
}

/// With the digits that a golden keeps.
double AsWritten(double value) { return std::stod(fmt::format("{:.4g}", value)); }

/// The events of the comparison's actual side, in order of time; each takes its partner's comments
/// and tolerance, and where nothing changed the acceptance it is from.
void TakeOver(Golden& golden, const Golden& old, const grammar::Timeline& recognised) {
  Lines homeless;
  for (const Pairing& pairing : Compare(old, recognised, 0).pairings) {
    Lines comments = pairing.expected ? old.events[pairing.golden_line].comments : Lines{};
    MoveTo(homeless, comments);
    if (!pairing.actual) continue;
    GoldenEvent line{.event = *pairing.actual, .tolerance_ms = {}, .because = {}, .comments = {}};
    line.accepted = static_cast<int>(old.accepted.size()) + 1;
    if (pairing.expected) {
      if (IsExactly(pairing)) line.accepted = old.events[pairing.golden_line].accepted;
      line.tolerance_ms = old.events[pairing.golden_line].tolerance_ms;
      line.because = old.events[pairing.golden_line].because;
    }
    if (pairing.expected) MoveTo(line.comments, homeless);
    golden.events.push_back(std::move(line));
  }
  golden.closing_comments = std::move(homeless);
  golden.closing_comments.insert(golden.closing_comments.end(), old.closing_comments.begin(),
                                 old.closing_comments.end());
}

}  // namespace

Golden ProposeGolden(const std::optional<Golden>& old, const grammar::Timeline& recognised,
                     const Proposal& proposal) {
  Golden golden{.scenario = proposal.scenario, .grammar = proposal.grammar};
  golden.ticks_per_second = recognised.ticks_per_second;
  if (old) {
    golden.derived = old->derived;
    golden.accepted = old->accepted;
    golden.comments = old->comments;
  }
  if (!proposal.derived.empty()) golden.derived = proposal.derived;
  if (proposal.acceptance) golden.accepted.push_back(*proposal.acceptance);
  TakeOver(golden, old.value_or(Golden{.ticks_per_second = recognised.ticks_per_second}),
           recognised);
  for (GoldenEvent& line : golden.events) {
    line.event.decided = 0;
    for (grammar::NamedValue& value : line.event.values) value.value = AsWritten(value.value);
  }
  std::stable_sort(
      golden.events.begin(), golden.events.end(),
      [](const GoldenEvent& a, const GoldenEvent& b) { return ComesBefore(a.event, b.event); });
  return golden;
}

bool SaysTheSame(const Golden& golden, const grammar::Timeline& recognised) {
  if (golden.ticks_per_second != recognised.ticks_per_second) return false;
  const Comparison comparison = Compare(golden, recognised, 0);
  return std::ranges::all_of(comparison.pairings, IsExactly);
}

}  // namespace prehend::harness

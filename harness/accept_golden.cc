// SPDX-License-Identifier: Apache-2.0
// See harness/accept_golden.h. Tested by tests/harness/accept_golden_test.cc
#include "harness/accept_golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "harness/compare.h"
#include "harness/content_hash.h"
#include "harness/event_text.h"
#include "harness/oracle_notes.h"
#include "harness/shell_word.h"

namespace prehend::harness {
namespace {

using Lines = std::vector<std::string>;

/// With what a golden keeps of it, and the digits.
grammar::NamedEvent AsWritten(grammar::NamedEvent event) {
  event.decided = 0;
  for (grammar::NamedValue& value : event.values)
    value.value = std::stod(fmt::format("{:.4g}", value.value));
  return event;
}

void Append(Lines& to, const Lines& lines) { to.insert(to.end(), lines.begin(), lines.end()); }

/// What people wrote above an event that is gone.
Lines Farewell(const GoldenEvent& gone, grammar::Tick ticks_per_second) {
  if (gone.comments.empty()) return {};
  Lines lines = {fmt::format("was above {} {}, which is gone:", gone.event.Label(),
                             IntervalText(gone.event.interval, ticks_per_second))};
  Append(lines, gone.comments);
  return lines;
}

/// What the run proposes, with everything that people wrote.
class TakeOver {
 public:
  TakeOver(const Golden& old, const grammar::Timeline& recognised, const Proposal& proposal)
      : old_(old),
        proposal_(proposal),
        same_ticks_(old.ticks_per_second == recognised.ticks_per_second),
        next_(static_cast<int>(old.accepted.size()) + 1),
        tolerance_ms_(MillisecondsOf(proposal.tolerance, recognised.ticks_per_second)) {}

  void Pair(const Pairing& pairing, Golden& golden) {
    const GoldenEvent* partner = pairing.expected ? &old_.events[pairing.golden_line] : nullptr;
    if (pairing.actual) {
      golden.events.push_back(LineOf(pairing, partner));
      Note(NoteOf(*pairing.actual), golden.events.back());
    } else if (partner) {
      gone_.push_back(partner);
    }
  }

  /// What only the oracle sees.
  void TakeOverUnseen(Golden& golden) {
    std::vector<const GoldenEvent*> kept;
    for (const OracleNote& note : proposal_.notes) {
      if (note.text != kOnlyOracle) continue;
      const auto known = std::ranges::find_if(old_.events, [&](const GoldenEvent& line) {
        return !line.IsExpected() && same_ticks_ && IsNear(line.event, note.event);
      });
      if (known != old_.events.end()) {
        kept.push_back(&*known);
        golden.events.push_back(*known);
      } else {
        golden.events.push_back({.event = AsWritten(note.event)});
        Note(kOnlyOracle, golden.events.back());
      }
    }
    for (const GoldenEvent& line : old_.events) {
      if (!line.IsExpected() && std::ranges::count(kept, &line) == 0) gone_.push_back(&line);
    }
  }

  /// Comments of a line that is gone stay above what begins as it did; others go to the end.
  void KeepComments(Golden& golden) const {
    for (const GoldenEvent* gone : gone_) {
      const auto heir = std::ranges::find_if(golden.events, [&](const GoldenEvent& line) {
        return line.comments.empty() && same_ticks_ && BeginsAs(line.event, gone->event);
      });
      if (heir != golden.events.end()) {
        heir->comments = gone->comments;
      } else {
        Append(golden.closing_comments, Farewell(*gone, old_.ticks_per_second));
      }
    }
  }

 private:
  /// Where boundaries moved within the tolerance, nobody was shown that they did: such a line
  /// stays.
  GoldenEvent LineOf(const Pairing& pairing, const GoldenEvent* partner) const {
    const bool agrees = pairing.agreement == LineVerdict::kMatched;
    if (partner && agrees && same_ticks_) return *partner;
    GoldenEvent line = partner ? *partner : GoldenEvent();
    line.as_written.clear();
    line.event = AsWritten(*pairing.actual);
    if (!agrees) line.accepted = next_;
    return line;
  }

  std::string NoteOf(const grammar::NamedEvent& event) const {
    const auto note = std::ranges::find_if(proposal_.notes, [&](const OracleNote& candidate) {
      return candidate.text != kOnlyOracle && candidate.event.interval == event.interval &&
             candidate.event.Label() == event.Label();
    });
    return note == proposal_.notes.end() ? "" : note->text;
  }

  void Note(const std::string& now, GoldenEvent& line) const {
    if (SameNote(line.oracle, now, tolerance_ms_)) return;
    line.as_written.clear();
    line.accepted = next_;
    line.oracle = now;
    line.oracle_because = now.empty() ? "" : kReasonWanted;
  }

  bool BeginsAs(const grammar::NamedEvent& a, const grammar::NamedEvent& b) const {
    return a.Label() == b.Label() &&
           std::abs(a.interval.begin - b.interval.begin) <= proposal_.tolerance;
  }

  bool IsNear(const grammar::NamedEvent& a, const grammar::NamedEvent& b) const {
    return BeginsAs(a, b) && std::abs(a.interval.end - b.interval.end) <= proposal_.tolerance;
  }

  const Golden& old_;
  const Proposal& proposal_;
  const bool same_ticks_;
  const int next_;  ///< acceptance
  const double tolerance_ms_;
  std::vector<const GoldenEvent*> gone_;  ///< lines of the old golden without one in the new
};

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
  const Golden before = old.value_or(Golden{.ticks_per_second = recognised.ticks_per_second});
  TakeOver take_over(before, recognised, proposal);
  for (const Pairing& pairing : Compare(before, recognised, proposal.tolerance).pairings)
    take_over.Pair(pairing, golden);
  take_over.TakeOverUnseen(golden);
  take_over.KeepComments(golden);
  std::stable_sort(
      golden.events.begin(), golden.events.end(),
      [](const GoldenEvent& a, const GoldenEvent& b) { return ComesBefore(a.event, b.event); });
  return golden;
}

Golden PendingGolden(const std::optional<Golden>& old, const grammar::Timeline& recognised,
                     const std::string& scenario, const std::string& grammar,
                     const Derivation& derivation) {
  Proposal proposal;
  proposal.scenario = scenario;
  proposal.grammar = grammar;
  proposal.notes = derivation.notes;
  proposal.tolerance = derivation.tolerance;
  return ProposeGolden(old, recognised, proposal);
}

std::string Fingerprint(const Golden& pending) { return ContentHash(WriteGolden(pending)); }

std::string AcceptCommandLine(const std::string& scenario, const std::string& fingerprint,
                              bool wants_reason) {
  return fmt::format("prehend accept {} --reviewed {} --reason \"...\"{}", ShellQuoted(scenario),
                     fingerprint,
                     wants_reason ? " --against-the-oracle \"EVENT(ROLES): ...\"" : "");
}

}  // namespace prehend::harness

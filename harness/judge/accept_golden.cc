// SPDX-License-Identifier: Apache-2.0
// See harness/judge/accept_golden.h. Tested by tests/harness/judge/accept_golden_test.cc
#include "harness/judge/accept_golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "harness/base/content_hash.h"
#include "harness/base/shell_quote.h"
#include "harness/golden/compare.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {
namespace {

using Lines = std::vector<std::string>;

/// The event as a golden stores it: no decision tick, values with four significant digits.
grammar::NamedEvent AsWritten(grammar::NamedEvent event) {
  event.decided = 0;
  for (grammar::NamedValue& value : event.values)
    value.value = std::stod(fmt::format("{:.4g}", value.value));
  return event;
}

void Append(Lines& to, const Lines& lines) { to.insert(to.end(), lines.begin(), lines.end()); }

/// Comments of a removed event, below a line that names it.
Lines CommentsOfRemoved(const GoldenEvent& removed, grammar::Tick ticks_per_second) {
  if (removed.comments.empty()) return {};
  Lines lines = {fmt::format("was above {} {}, which is gone:", removed.event.Label(),
                             IntervalText(removed.event.interval, ticks_per_second))};
  Append(lines, removed.comments);
  return lines;
}

/// Merges what a run recognised into the lines of the old golden.
class MergeIntoGolden {
 public:
  MergeIntoGolden(const Golden& old, const grammar::Timeline& recognised, const Proposal& proposal)
      : old_(old),
        proposal_(proposal),
        same_ticks_(old.ticks_per_second == recognised.ticks_per_second),
        next_(static_cast<int>(old.accepted.size()) + 1) {}

  void Add(const Pairing& pairing, Golden& golden) {
    const GoldenEvent* partner = pairing.expected ? &old_.events[pairing.golden_line] : nullptr;
    if (pairing.actual) {
      golden.events.push_back(LineOf(pairing, partner));
    } else if (partner) {
      removed_.push_back(partner);
    }
  }

  /// Of removed lines.
  void KeepComments(Golden& golden) const {
    for (const GoldenEvent* removed : removed_) {
      const auto successor = std::ranges::find_if(golden.events, [&](const GoldenEvent& line) {
        return line.comments.empty() && same_ticks_ && BeginsAs(line.event, removed->event);
      });
      if (successor != golden.events.end()) {
        successor->comments = removed->comments;
      } else {
        Append(golden.closing_comments, CommentsOfRemoved(*removed, old_.ticks_per_second));
      }
    }
  }

 private:
  /// A line whose boundaries moved within the tolerance stays, unless somebody asks for them:
  /// nobody was shown that they did.
  GoldenEvent LineOf(const Pairing& pairing, const GoldenEvent* partner) const {
    const bool agrees = pairing.agreement == LineVerdict::kMatched;
    const bool moved = pairing.begin_offset != 0 || pairing.end_offset != 0;
    if (partner && agrees && same_ticks_ && !(proposal_.exact && moved)) return *partner;
    GoldenEvent line = partner ? *partner : GoldenEvent();
    line.as_written.clear();
    line.spread = {};
    line.event = AsWritten(*pairing.actual);
    if (!agrees || (proposal_.exact && moved)) line.accepted = next_;
    return line;
  }

  bool BeginsAs(const grammar::NamedEvent& a, const grammar::NamedEvent& b) const {
    return a.Label() == b.Label() &&
           std::abs(a.interval.begin - b.interval.begin) <= proposal_.tolerance;
  }

  const Golden& old_;
  const Proposal& proposal_;
  const bool same_ticks_;
  const int next_;                           ///< number of this acceptance
  std::vector<const GoldenEvent*> removed_;  ///< lines of the old golden without one in the new
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
    golden.unsteady = old->unsteady;
    golden.ensemble_plays = old->ensemble_plays;
    golden.comments = old->comments;
    golden.closing_comments = old->closing_comments;
  }
  if (!proposal.derived.empty()) golden.derived = proposal.derived;
  if (proposal.acceptance) golden.accepted.push_back(*proposal.acceptance);
  const Golden before = old.value_or(Golden{.ticks_per_second = recognised.ticks_per_second});
  MergeIntoGolden merge(before, recognised, proposal);
  for (const Pairing& pairing : Compare(before, recognised, proposal.tolerance).pairings)
    merge.Add(pairing, golden);
  merge.KeepComments(golden);
  std::stable_sort(
      golden.events.begin(), golden.events.end(),
      [](const GoldenEvent& a, const GoldenEvent& b) { return ComesBefore(a.event, b.event); });
  return golden;
}

Golden PendingGolden(const std::optional<Golden>& old, const grammar::Timeline& recognised,
                     const std::string& scenario, const std::string& grammar,
                     const OracleComparison& truth) {
  const Lines derived = old ? old->derived : Lines();
  const bool holds = old && AcceptedDiffering(derived) == truth.Differing();
  return ProposeGolden(old, recognised,
                       {.scenario = scenario,
                        .grammar = grammar,
                        .derived = holds ? derived : RenewedDerivation(derived, OracleLine(truth)),
                        .acceptance = {},
                        .tolerance = truth.tolerance});
}

std::string EventLines(const Golden& golden) {
  std::vector<std::vector<std::string>> rows;
  std::size_t role_columns = 1;
  for (const GoldenEvent& line : golden.events)
    role_columns = std::max(role_columns, line.event.roles.size());
  for (const GoldenEvent& line : golden.events) {
    rows.push_back(EventCells(line.event, golden.ticks_per_second, role_columns));
  }
  std::string text;
  for (const std::string& line : AlignColumns(rows)) text += line + "\n";
  return text;
}

std::string Fingerprint(const Golden& pending) { return ContentHash(WriteGolden(pending)); }

std::string AcceptCommandLine(const std::string& scenario, const std::string& fingerprint,
                              const std::string& grammar) {
  std::vector<std::string> words = {"accept", scenario, "--reviewed", fingerprint};
  if (!grammar.empty()) words.insert(words.end(), {"--grammar", grammar});
  return CommandText(words) + " --reason \"...\"";
}

std::string AcceptPicturesCommand(const std::string& scenario) {
  return CommandText({"accept", scenario, "--pictures"}) + " --reason \"...\"";
}

}  // namespace prehend::harness

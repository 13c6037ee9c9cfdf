// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/accept_golden.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/quoting.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
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
Lines CommentsOfRemoved(const truth::GoldenEvent& removed, grammar::Tick ticks_per_second) {
  if (removed.comments.empty()) return {};
  Lines lines = {fmt::format("was above {} {}, which is gone:", removed.event.Label(),
                             truth::IntervalText(removed.event.interval, ticks_per_second))};
  Append(lines, removed.comments);
  return lines;
}

/// Merges what a run recognised into the lines of the old golden.
class MergeIntoGolden {
 public:
  MergeIntoGolden(const truth::Golden& old, const grammar::Timeline& recognised,
                  const Proposal& proposal)
      : old_(old),
        proposal_(proposal),
        same_ticks_(old.ticks_per_second == recognised.ticks_per_second),
        next_(static_cast<int>(old.accepted.size()) + 1) {}

  void Add(const truth::Pairing& pairing, truth::Golden& golden) {
    const truth::GoldenEvent* partner =
        pairing.expected ? &old_.events[pairing.golden_line] : nullptr;
    if (pairing.actual) {
      golden.events.push_back(LineOf(pairing, partner));
    } else if (partner) {
      removed_.push_back(partner);
    }
  }

  /// Of removed lines.
  void KeepComments(truth::Golden& golden) const {
    for (const truth::GoldenEvent* removed : removed_) {
      const auto successor =
          std::ranges::find_if(golden.events, [&](const truth::GoldenEvent& line) {
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
  truth::GoldenEvent LineOf(const truth::Pairing& pairing,
                            const truth::GoldenEvent* partner) const {
    const bool agrees = pairing.agreement == truth::LineVerdict::kMatched;
    const bool moved = pairing.begin_offset != 0 || pairing.end_offset != 0;
    if (partner && agrees && same_ticks_ && !(proposal_.exact && moved)) return *partner;
    truth::GoldenEvent line = partner ? *partner : truth::GoldenEvent();
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

  const truth::Golden& old_;
  const Proposal& proposal_;
  const bool same_ticks_;
  const int next_;  ///< number of this acceptance
  std::vector<const truth::GoldenEvent*>
      removed_;  ///< lines of the old golden without one in the new
};

}  // namespace

truth::Golden ProposeGolden(const std::optional<truth::Golden>& old,
                            const grammar::Timeline& recognised, const Proposal& proposal) {
  truth::Golden golden{.scenario = proposal.scenario, .grammar = proposal.grammar};
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
  const truth::Golden before =
      old.value_or(truth::Golden{.ticks_per_second = recognised.ticks_per_second});
  MergeIntoGolden merge(before, recognised, proposal);
  for (const truth::Pairing& pairing :
       truth::Compare(before, recognised, proposal.tolerance).pairings)
    merge.Add(pairing, golden);
  merge.KeepComments(golden);
  std::stable_sort(golden.events.begin(), golden.events.end(),
                   [](const truth::GoldenEvent& a, const truth::GoldenEvent& b) {
                     return ComesBefore(a.event, b.event);
                   });
  return golden;
}

truth::Golden PendingGolden(const std::optional<truth::Golden>& old,
                            const grammar::Timeline& recognised, const std::string& scenario,
                            const std::string& grammar, const OracleComparison& truth) {
  const Lines derived = old ? old->derived : Lines();
  const bool holds = old && AcceptedDiffering(derived) == truth.Differing();
  return ProposeGolden(old, recognised,
                       {.scenario = scenario,
                        .grammar = grammar,
                        .derived = holds ? derived : RenewedDerivation(derived, OracleLine(truth)),
                        .tolerance = truth.tolerance});
}

std::string EventLines(const truth::Golden& golden) {
  std::vector<std::vector<std::string>> rows;
  std::size_t role_columns = 1;
  for (const truth::GoldenEvent& line : golden.events)
    role_columns = std::max(role_columns, line.event.roles.size());
  for (const truth::GoldenEvent& line : golden.events) {
    rows.push_back(truth::EventCells(line.event, golden.ticks_per_second, role_columns));
  }
  std::string text;
  for (const std::string& line : truth::AlignColumns(rows)) text += line + "\n";
  return text;
}

std::string Fingerprint(const truth::Golden& pending) {
  return ContentHash(truth::WriteGolden(pending));
}

std::string AcceptCommandLine(const std::string& scenario, const std::string& fingerprint,
                              const std::string& grammar) {
  std::vector<std::string> words = {"accept", scenario, "--reviewed", fingerprint};
  if (!grammar.empty()) words.insert(words.end(), {"--grammar", grammar});
  return CommandText(words) + " --reason \"...\"";
}

std::string AcceptPicturesCommand(const std::string& scenario) {
  return CommandText({"accept", scenario, "--pictures"}) + " --reason \"...\"";
}

}  // namespace prehend::suite

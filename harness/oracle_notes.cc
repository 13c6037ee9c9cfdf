// SPDX-License-Identifier: Apache-2.0
// See harness/oracle_notes.h. Tested by tests/harness/accept_golden_test.cc
#include "harness/oracle_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/event_text.h"

namespace prehend::harness {
namespace {

bool WantsReason(const GoldenEvent& line) {
  return !line.oracle.empty() && line.oracle_because == kReasonWanted;
}

/// "begin 29.2 ms earlier": an event that is later than the oracle's is seen earlier by it.
std::string OffsetText(const char* boundary, double later_ms) {
  return fmt::format("{} {:.1f} ms {}", boundary, std::abs(later_ms),
                     later_ms > 0 ? "earlier" : "later");
}

/// What it says against an event.
std::string Says(const GoldenEvent& line) {
  if (line.oracle == kNotOfOracle) return "the oracle sees no such event";
  if (line.oracle == kOnlyOracle) return "only the oracle sees this event";
  const auto offsets = NoteOffsets_ms(line.oracle);
  if (!offsets) return "the oracle sees it otherwise";
  return "the oracle sees it " + OffsetText("begin", offsets->first) + " and " +
         OffsetText("end", offsets->second);
}

std::string EventText(const GoldenEvent& line, grammar::Tick ticks_per_second) {
  return line.event.Label() + " " + IntervalText(line.event.interval, ticks_per_second);
}

/// The line of `pending` about the same event; null when there is none, or it became another.
const GoldenEvent* SameEvent(const GoldenEvent& line, const Golden& pending) {
  const auto found = std::ranges::find_if(pending.events, [&](const GoldenEvent& other) {
    return other.event.interval == line.event.interval && other.event.Label() == line.event.Label();
  });
  return found == pending.events.end() ? nullptr : &*found;
}

/// A note that people gave a reason for, and that is not true any more.
bool IsOutOfDate(const GoldenEvent& line, const Golden& pending) {
  if (line.oracle.empty()) return false;
  const GoldenEvent* now = SameEvent(line, pending);
  // An event that is gone or moved is among the differences, not here.
  return now ? now->oracle.empty() : !line.IsExpected();
}

/// The label that a reason is for, and the reason; the label is empty when it is for all.
std::pair<std::string, std::string> SplitReason(const std::string& text) {
  const std::size_t end = text.find("): ");
  const std::size_t open = text.find_first_of("( ");
  const bool names_event = end != std::string::npos && open != 0 && open < end && text[open] == '(';
  if (!names_event) return {"", text};
  return {text.substr(0, end + 1), text.substr(end + 3)};
}

std::string Listed(const std::set<std::string>& labels) {
  return fmt::format("{}", fmt::join(labels, ", "));
}

}  // namespace

bool SameNote(const std::string& was, const std::string& now, double tolerance_ms) {
  const auto before = NoteOffsets_ms(was), after = NoteOffsets_ms(now);
  if (!before || !after) return was == now;
  const double apart_ms =
      std::max(std::abs(before->first - after->first), std::abs(before->second - after->second));
  return apart_ms <= tolerance_ms + 0.1;  // notes have one decimal
}

std::vector<Objection> Objections(const std::optional<Golden>& golden, const Golden& pending) {
  std::vector<Objection> objections;
  for (const GoldenEvent& line : pending.events) {
    if (WantsReason(line))
      objections.push_back(
          {line, Says(line) + ": " + EventText(line, pending.ticks_per_second), true});
  }
  if (!golden || golden->ticks_per_second != pending.ticks_per_second) return objections;
  for (const GoldenEvent& line : golden->events) {
    if (!IsOutOfDate(line, pending)) continue;
    objections.push_back(
        {line, fmt::format("the oracle agrees by now, and the note oracle={} is out of date: {}",
                           line.oracle, EventText(line, golden->ticks_per_second))});
  }
  return objections;
}

bool WantsReason(const std::vector<Objection>& objections) {
  return std::ranges::any_of(objections, &Objection::wants_reason);
}

std::string Text(const std::vector<Objection>& objections) {
  std::string text;
  for (const Objection& objection : objections) text += objection.text + "\n";
  return text;
}

std::string Summary(const std::vector<Objection>& objections) {
  const auto wanting = std::ranges::count_if(objections, &Objection::wants_reason);
  if (wanting > 0)
    return fmt::format("the physical oracle objects to {} event{}", wanting,
                       wanting > 1 ? "s" : "");
  return objections.size() == 1
             ? "a note about the physical oracle is out of date"
             : fmt::format("{} notes about the physical oracle are out of date", objections.size());
}

std::string GiveReasons(const std::vector<std::string>& reasons, Golden& golden) {
  std::set<std::string> wanting;
  for (const GoldenEvent& line : golden.events) {
    if (WantsReason(line)) wanting.insert(line.event.Label());
  }
  if (wanting.empty())
    return reasons.empty() ? ""
                           : "--against-the-oracle: the physical oracle objects to nothing here";
  std::map<std::string, std::string> reason_for;
  for (const std::string& text : reasons) {
    const auto [label, why] = SplitReason(text);
    if (why.find_first_not_of(" \t") == std::string::npos)
      return "--against-the-oracle needs a reason";
    if (!label.empty() && !wanting.contains(label))
      return "--against-the-oracle: the physical oracle does not object to " + label + ", but to " +
             Listed(wanting);
    if (!reason_for.emplace(label, why).second)
      return "--against-the-oracle gives two reasons for " +
             (label.empty() ? "the same events" : label);
  }
  std::set<std::string> unexplained;
  for (GoldenEvent& line : golden.events) {
    if (!WantsReason(line)) continue;
    auto reason = reason_for.find(line.event.Label());
    if (reason == reason_for.end()) reason = reason_for.find("");
    if (reason == reason_for.end()) {
      unexplained.insert(line.event.Label());
    } else {
      line.oracle_because = reason->second;
    }
  }
  return unexplained.empty() ? "" : "the physical oracle objects to " + Listed(unexplained);
}

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// A comparison in words. A comparison for programs. Tested by
// tests/harness/truth/golden/compare_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>

#include "harness/base/base/quoting.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::truth {
namespace {

using grammar::Tick;

/// "begin +50.0 ms, end -2.1 ms (tolerance 8.3 ms)"
std::string OffsetText(const Pairing& pairing, Tick ticks_per_second) {
  return fmt::format("begin {:+.1f} ms, end {:+.1f} ms (tolerance {:.1f} ms)",
                     MillisecondsOf(pairing.begin_offset, ticks_per_second),
                     MillisecondsOf(pairing.end_offset, ticks_per_second),
                     MillisecondsOf(pairing.tolerance, ticks_per_second));
}

/// "3 pieces: 1.0000..1.2000 s, .."
std::string PiecesText(const std::vector<grammar::Interval>& pieces, Tick ticks_per_second) {
  std::vector<std::string> texts;
  for (const grammar::Interval& piece : pieces)
    texts.push_back(IntervalText(piece, ticks_per_second));
  return fmt::format("{} pieces: {}", pieces.size(), fmt::join(texts, ", "));
}

std::string PairingText(const Pairing& pairing, Tick ticks_per_second, std::string_view command,
                        std::string_view facts) {
  const auto side = [&](const std::optional<grammar::NamedEvent>& event) {
    const bool is_actual = &event == &pairing.actual;
    const bool in_pieces =
        !pairing.pieces.empty() && is_actual == (pairing.agreement == LineVerdict::kFragmented);
    if (in_pieces) return PiecesText(pairing.pieces, ticks_per_second);
    return event ? IntervalText(event->interval, ticks_per_second) : std::string("nothing");
  };
  std::string text = fmt::format("{} {}\n", Name(pairing.agreement), pairing.event().Label());
  text +=
      fmt::format("  expected {}, recognised {}\n", side(pairing.expected), side(pairing.actual));
  if (pairing.expected && pairing.actual && pairing.pieces.empty())
    text += fmt::format("  {}\n", OffsetText(pairing, ticks_per_second));
  if (!pairing.changes.empty()) text += fmt::format("  {}\n", fmt::join(pairing.changes, ", "));
  text += facts;
  if (!command.empty())
    text += fmt::format("  why: {} {}\n", command, QuestionAbout(pairing, ticks_per_second));
  return text;
}

using Json = nlohmann::ordered_json;

Json SideJson(const std::optional<grammar::NamedEvent>& event, Tick ticks_per_second) {
  if (!event) return nullptr;
  Json json = EventJson(*event, ticks_per_second);
  json.erase("decided_tick");  // a golden does not say it
  return json;
}

Json PairingJson(const Pairing& pairing, Tick ticks_per_second, std::string_view command) {
  const auto offset_ms = [&](Tick ticks) {
    return pairing.expected && pairing.actual ? Json(MillisecondsOf(ticks, ticks_per_second))
                                              : Json(nullptr);
  };
  const auto seconds = [&](Tick tick) { return MillisecondsOf(tick, ticks_per_second) / 1000; };
  Json pieces = Json::array();
  for (const grammar::Interval& piece : pairing.pieces)
    pieces.push_back({{"begin_s", seconds(piece.begin)}, {"end_s", seconds(piece.end)}});
  return {{"kind", Name(pairing.agreement)},
          {"event", pairing.event().event},
          {"expected", SideJson(pairing.expected, ticks_per_second)},
          {"recognised", SideJson(pairing.actual, ticks_per_second)},
          {"begin_ms", offset_ms(pairing.begin_offset)},
          {"end_ms", offset_ms(pairing.end_offset)},
          {"tolerance_ms", offset_ms(pairing.tolerance)},
          {"changes", pairing.changes},
          {"pieces", std::move(pieces)},
          {"why", std::string(command) + " " + QuestionAbout(pairing, ticks_per_second)}};
}

}  // namespace

std::string_view Name(LineVerdict agreement) {
  constexpr std::array<std::string_view, 8> kNames = {
      "matched", "shifted", "changed", "relabelled", "fragmented", "merged", "missing", "extra"};
  return kNames.at(static_cast<std::size_t>(agreement));
}

// Asks why an event is as it is, or why it is missing; of a fragmented event about the first
// fragment, which ends where the event broke.
std::string QuestionAbout(const Pairing& pairing, Tick ticks_per_second) {
  const grammar::NamedEvent& event = pairing.actual ? *pairing.actual : *pairing.expected;
  const bool in_pieces = pairing.agreement == LineVerdict::kFragmented && !pairing.pieces.empty();
  const Tick begin = in_pieces ? pairing.pieces.front().begin : event.interval.begin;
  std::string question = event.event;
  for (const grammar::Role& role : event.roles) {
    if (!IsAttribute(role)) question += " " + role.value;
  }
  question += " @" + SecondsText(begin, ticks_per_second) + "s";
  return (pairing.actual ? "--event " : "--expected ") + ShellQuoted(question);
}

std::string DifferenceText(const Comparison& comparison, std::string_view command,
                           std::string_view facts) {
  const std::vector<const Pairing*> differing = comparison.Differing();
  std::string text;
  for (const Pairing* pairing : differing) {
    text += PairingText(*pairing, comparison.ticks_per_second, command,
                        pairing == differing.front() ? facts : std::string_view());
  }
  for (const RelationChange& change : comparison.relations) {
    text += fmt::format("relation {} {} {}: now {}\n", change.first, change.expected, change.second,
                        change.actual);
  }
  return text;
}

std::string MarginText(const Comparison& comparison) {
  if (comparison.margins.empty()) return "";
  const Margin* smallest = comparison.Smallest();
  if (!smallest) return "margin: all boundaries match exactly";
  const auto ms = [&](Tick ticks) { return MillisecondsOf(ticks, comparison.ticks_per_second); };
  if (smallest->Left() == 0)
    return fmt::format("passed at the limit: {} {} {:.1f} ms off (tolerance {:.1f} ms)",
                       smallest->label, smallest->at_end ? "ends" : "begins",
                       ms(std::abs(smallest->offset)), ms(smallest->tolerance));
  return fmt::format("margin: {:.1f} of {:.1f} ms left at {}", ms(smallest->Left()),
                     ms(smallest->tolerance), smallest->Boundary());
}

Json DifferencesJson(const Comparison& comparison, std::string_view command) {
  Json differences = Json::array();
  for (const Pairing* pairing : comparison.Differing())
    differences.push_back(PairingJson(*pairing, comparison.ticks_per_second, command));
  return differences;
}

Json RelationsJson(const Comparison& comparison) {
  Json relations = Json::array();
  for (const RelationChange& change : comparison.relations) {
    relations.push_back({{"first", change.first},
                         {"second", change.second},
                         {"expected", change.expected},
                         {"recognised", change.actual}});
  }
  return relations;
}

}  // namespace prehend::truth

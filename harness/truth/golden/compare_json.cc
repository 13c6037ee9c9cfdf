// SPDX-License-Identifier: Apache-2.0
// A comparison for programs. Tested by tests/harness/truth/golden/compare_test.cc
#include <nlohmann/json.hpp>

#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"
#include "harness/truth/timeline/timeline_json.h"

namespace prehend::truth {
namespace {

using Json = nlohmann::ordered_json;
using grammar::Tick;

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

// SPDX-License-Identifier: Apache-2.0
// A verdict as JSON: for people's programs with documented keys, for the pipe of a worker and the
// record of the last pass with all fields of its structs. Tested by
// tests/harness/suite/check/verdict_test.cc
#include <nlohmann/json.hpp>

#include "harness/base/base/text_file.h"
#include "harness/suite/check/verdict.h"
#include "harness/truth/timeline/event_text.h"
#include "harness/truth/timeline/timeline_wire.h"

namespace nlohmann {

template <typename T>
struct adl_serializer<std::optional<T>> {
  static void to_json(json& packed, const std::optional<T>& value) {
    packed = value ? json(*value) : json(nullptr);
  }
  static void from_json(const json& packed, std::optional<T>& value) {
    value = packed.is_null() ? std::nullopt : std::optional<T>(packed.get<T>());
  }
};

}  // namespace nlohmann

namespace prehend::grammar {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Place, line, column)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Diagnostic, file, place, message, source_line, caret_column,
                                   hint, is_warning)

}  // namespace prehend::grammar

namespace prehend::truth {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EventDrawing, as, color, ghost, hand, first, last)

inline void to_json(nlohmann::json& packed, const EventDrawings& drawings) {
  packed = drawings.all();
}
inline void from_json(const nlohmann::json& packed, EventDrawings& drawings) {
  drawings = EventDrawings(packed.get<EventDrawings::ByEvent>());
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Pairing, agreement, expected, actual, golden_line, begin_offset,
                                   end_offset, tolerance, changes, pieces)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RelationChange, first, second, expected, actual)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Margin, label, at_end, offset, tolerance)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Comparison, ticks_per_second, pairings, relations, margins)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ClaimVerdict, claim, place, says, found, times)

}  // namespace prehend::truth

namespace prehend::show {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlayedStep, who, what, begin, end)

}  // namespace prehend::show

namespace prehend::suite {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReportedPicture, file, caption)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DrawnDifference, what, expected, recognised, in_golden, in_run)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Mishap, tick, what, object, question, is_miss)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Handling, event, hand, object, support, begin, end, open_end)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Demonstration, success, ticks_per_second, end, handled, mishaps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Attribution, event, what, shift_ms, because, question)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScenarioVerdict, scenario, file, shows, verdict, exit_code,
                                   reason, errors, details, notes, claims, comparison, has_golden,
                                   drawings, explain, cause, attributions, settings, command,
                                   state_hash, ticks, seconds, peak_memory_kib, inputs, pictures,
                                   not_recorded, picture_differences, drawn_differences, explained,
                                   demonstration, replay, steps)

namespace {

using Json = nlohmann::ordered_json;

Json BoundariesJson(const truth::Comparison& comparison) {
  Json boundaries = Json::array();
  for (const truth::Margin& margin : comparison.margins) {
    boundaries.push_back(
        {{"boundary", margin.Boundary()},
         {"offset_ms", truth::MillisecondsOf(margin.offset, comparison.ticks_per_second)},
         {"tolerance_ms", truth::MillisecondsOf(margin.tolerance, comparison.ticks_per_second)}});
  }
  return boundaries;
}

Json AttributionsJson(const std::vector<Attribution>& attributions) {
  Json list = Json::array();
  for (const Attribution& difference : attributions)
    list.push_back({{"event", difference.event},
                    {"what", difference.what},
                    {"shift_ms", difference.shift_ms},
                    {"because", difference.because}});
  return list;
}

Json InputsJson(const FileHashes& inputs) {
  Json hashes = Json::object();
  for (const auto& [path, hash] : inputs) hashes[ReadableName(path)] = hash;
  return hashes;
}

}  // namespace

Json DiagnosticsJson(const grammar::Diagnostics& diagnostics) {
  Json all = Json::array();
  for (const grammar::Diagnostic& diagnostic : diagnostics)
    all.push_back({{"file", diagnostic.file},
                   {"line", diagnostic.place.line},
                   {"column", diagnostic.place.column},
                   {"message", diagnostic.message},
                   {"hint", diagnostic.hint}});
  return all;
}

Json VerdictJson(const ScenarioVerdict& verdict) {
  const truth::Comparison none;
  const truth::Comparison& compared =
      verdict.has_golden && verdict.comparison ? *verdict.comparison : none;
  Json pictures = Json::array();
  for (const ReportedPicture& picture : verdict.pictures)
    pictures.push_back({{"file", picture.file}, {"caption", picture.caption}});
  const FirstPlace where = WhereToLook(verdict);
  return {{"scenario", verdict.scenario},
          {"file", where.file},
          {"line", where.line},
          {"verdict", Name(verdict.verdict)},
          {"exit_code", static_cast<int>(verdict.exit_code)},
          {"reason", verdict.reason},
          {"details", DetailsText(verdict)},
          {"errors", DiagnosticsJson(verdict.errors)},
          {"notes", verdict.notes},
          {"claims", truth::ClaimsJson(verdict.claims)},
          {"differences", truth::DifferencesJson(compared, verdict.explain)},
          {"relations", truth::RelationsJson(compared)},
          {"blame", verdict.cause},
          {"causes", AttributionsJson(verdict.attributions)},
          {"headroom", MarginText(verdict)},
          {"boundaries", BoundariesJson(compared)},
          {"command", verdict.command},
          {"shows", verdict.shows},
          {"state_hash", verdict.state_hash},
          {"ticks", verdict.ticks},
          {"seconds", verdict.seconds},
          {"peak_memory_kib", verdict.peak_memory_kib},
          {"inputs", InputsJson(verdict.inputs)},
          {"pictures", std::move(pictures)}};
}

nlohmann::json Packed(const ScenarioVerdict& verdict) { return verdict; }

ScenarioVerdict UnpackedVerdict(const nlohmann::json& packed) {
  return packed.get<ScenarioVerdict>();
}

}  // namespace prehend::suite

// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "harness/base/base/quoting.h"
#include "harness/base/base/text_file.h"
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

std::string_view Name(Verdict verdict) {
  constexpr std::array<std::string_view, 5> kNames = {"passed", "failed", "pending", "flaky",
                                                      "unchanged"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

bool LeadsToReview(const ScenarioVerdict& verdict) {
  return verdict.verdict == Verdict::kPending &&
         verdict.command.starts_with(CommandText({"review"}));
}

std::string_view CommandLabel(const ScenarioVerdict& verdict) {
  return LeadsToReview(verdict) ? "next" : "again";
}

std::string MarginText(const ScenarioVerdict& verdict) {
  const bool good = verdict.verdict == Verdict::kPassed || verdict.verdict == Verdict::kUnchanged;
  return good && verdict.has_golden && verdict.comparison ? MarginText(*verdict.comparison) : "";
}

std::string NotesText(const ScenarioVerdict& verdict) {
  const std::size_t count = verdict.notes.size();
  if (count == 0) return "";
  if (verdict.exit_code == ExitCode::kAgrees)
    return count == 1 ? "1 note on its steps is in the report\n"
                      : fmt::format("{} notes on its steps are in the report\n", count);
  std::string text;
  for (const std::string& note : verdict.notes) text += note + "\n";
  return text;
}

FirstPlace WhereToLook(const ScenarioVerdict& verdict) {
  FirstPlace where{.file = verdict.file};
  const auto claim =
      std::ranges::find(verdict.claims, truth::kContradicted, &truth::ClaimVerdict::says);
  if (!verdict.errors.empty()) {
    where = {verdict.errors.front().file, std::max(1, verdict.errors.front().place.line)};
  } else if (claim != verdict.claims.end()) {
    const std::size_t colon = claim->place.rfind(':');
    where = {claim->place.substr(0, colon), std::stoi(claim->place.substr(colon + 1))};
  }
  std::error_code error;
  const std::string below = std::filesystem::current_path(error).string() + "/";
  if (where.file.starts_with(below)) where.file.erase(0, below.size());
  return where;
}

std::string DetailsText(const ScenarioVerdict& verdict) {
  return Format(verdict.errors) + verdict.details + verdict.warnings;
}

namespace {

bool SameOutcome(const ScenarioVerdict& a, const ScenarioVerdict& b) {
  const auto outcome = [](const ScenarioVerdict& v) {
    return std::tie(v.verdict, v.exit_code, v.reason, v.details, v.state_hash, v.ticks);
  };
  return outcome(a) == outcome(b) && Format(a.errors) == Format(b.errors);
}

/// "flaky: of 5 runs 3 passed, 2 failed; 2 different state hashes"
std::string FlakyReason(const std::vector<ScenarioVerdict>& runs) {
  std::map<std::string_view, int> counts;
  std::set<std::string> hashes;
  for (const ScenarioVerdict& run : runs) {
    ++counts[Name(run.verdict)];
    if (!run.state_hash.empty()) hashes.insert(run.state_hash);
  }
  std::string reason = fmt::format("flaky: of {} runs", runs.size());
  const char* separator = " ";
  for (const auto& [name, count] : counts)
    reason += fmt::format("{}{} {}", std::exchange(separator, ", "), count, name);
  if (hashes.size() > 1) reason += fmt::format("; {} different state hashes", hashes.size());
  return reason;
}

/// Events may agree while a picture does not, and the other way round.
ScenarioVerdict JudgedByPictures(ScenarioVerdict verdict) {
  if (verdict.picture_differences.empty()) return verdict;
  verdict.details += verdict.picture_differences;
  if (verdict.verdict == Verdict::kFailed || verdict.verdict == Verdict::kFlaky) return verdict;
  verdict.verdict = Verdict::kFailed;
  verdict.exit_code = ExitCode::kDiffers;
  verdict.reason = kPictureDiffers;
  return verdict;
}

}  // namespace

ScenarioVerdict MergeRepeats(const std::vector<ScenarioVerdict>& runs) {
  // The text of a failed run is of more use than that of a passed one.
  const auto failed = std::ranges::find_if(
      runs, [](const ScenarioVerdict& run) { return run.verdict != Verdict::kPassed; });
  ScenarioVerdict merged = failed == runs.end() ? runs.front() : *failed;
  for (const ScenarioVerdict& run : runs) {
    merged.seconds = std::max(merged.seconds, run.seconds);
    merged.peak_memory_kib = std::max(merged.peak_memory_kib, run.peak_memory_kib);
    if (!run.picture_differences.empty()) merged.picture_differences = run.picture_differences;
    if (!run.pictures.empty()) merged.pictures = run.pictures;
    if (!run.replay.empty()) merged.replay = run.replay;
    if (!run.drawn_differences.empty()) merged.drawn_differences = run.drawn_differences;
    if (!run.explained.events.empty()) merged.explained = run.explained;
    if (!run.not_recorded.empty()) merged.not_recorded = run.not_recorded;
  }
  const bool agree = std::ranges::all_of(
      runs, [&](const ScenarioVerdict& run) { return SameOutcome(run, runs.front()); });
  if (agree) return JudgedByPictures(std::move(merged));
  merged.verdict = Verdict::kFlaky;
  if (merged.exit_code != ExitCode::kFailure) merged.exit_code = ExitCode::kDiffers;
  merged.reason = FlakyReason(runs);
  return JudgedByPictures(std::move(merged));
}

Tally Count(const std::vector<ScenarioVerdict>& verdicts) {
  const auto count = [&](Verdict wanted) {
    return static_cast<int>(std::ranges::count(verdicts, wanted, &ScenarioVerdict::verdict));
  };
  return {.passed = count(Verdict::kPassed),
          .failed = count(Verdict::kFailed) + count(Verdict::kFlaky),
          .pending = count(Verdict::kPending),
          .unchanged = count(Verdict::kUnchanged)};
}

std::string SmallestMarginText(const std::vector<ScenarioVerdict>& verdicts) {
  double smallest_ms = std::numeric_limits<double>::infinity();
  std::string text;
  for (const ScenarioVerdict& verdict : verdicts) {
    if (!verdict.has_golden || !verdict.comparison) continue;
    const grammar::Tick ticks_per_second = verdict.comparison->ticks_per_second;
    for (const truth::Margin& margin : verdict.comparison->margins) {
      const double left_ms = truth::MillisecondsOf(margin.Left(), ticks_per_second);
      if (margin.offset == 0 || left_ms >= smallest_ms) continue;
      smallest_ms = left_ms;
      text = fmt::format("smallest margin: {:.1f} of {:.1f} ms left at {} of {}", left_ms,
                         truth::MillisecondsOf(margin.tolerance, ticks_per_second),
                         margin.Boundary(), verdict.scenario);
    }
  }
  return text;
}

ExitCode WorstOf(const std::vector<ScenarioVerdict>& verdicts) {
  if (verdicts.empty()) return ExitCode::kNothing;
  for (const ExitCode code :
       {ExitCode::kFailure, ExitCode::kBadInput, ExitCode::kDiffers, ExitCode::kPending}) {
    if (std::ranges::count(verdicts, code, &ScenarioVerdict::exit_code) > 0) return code;
  }
  return ExitCode::kAgrees;
}

// A verdict as JSON: for people's programs with documented keys, for the pipe of a worker and the
// record of the last pass with all fields of its structs. Tested by
// tests/harness/suite/check/verdict_test.cc

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReportedPicture, file, caption)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DrawnDifference, what, expected, recognised, in_golden, in_run)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Mishap, tick, what, object, question, is_miss)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Handling, event, hand, object, support, begin, end, open_end)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Demonstration, success, ticks_per_second, end, handled, mishaps)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Attribution, event, what, shift_ms, because, question)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScenarioVerdict, scenario, file, shows, verdict, exit_code,
                                   reason, errors, details, warnings, notes, claims, comparison,
                                   has_golden, drawings, explain, cause, attributions, settings,
                                   command, state_hash, ticks, seconds, peak_memory_kib, inputs,
                                   pictures, not_recorded, picture_differences, drawn_differences,
                                   explained, demonstration, replay, steps)

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

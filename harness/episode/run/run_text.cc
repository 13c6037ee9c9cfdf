// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/run_text.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/episode/run/load_run.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::episode {
namespace {

using grammar::NamedEvent;
using grammar::Tick;

bool Completed(const RunResult& run) {
  return run.status.kind == physics::RunStatus::Kind::kCompleted;
}

/// Of a recording up to its end, as its 'end_tick' and the events that are open there say.
Tick LengthOf(const RunResult& run) { return run.ticks + (run.is_recording ? 1 : 0); }

}  // namespace

std::string StatusText(const RunResult& run) {
  const physics::RunStatus& status = run.status;
  const Tick rate = run.timeline.ticks_per_second;
  if (Completed(run))
    return fmt::format("{}: {} s, {} ticks{}", run.is_unfinished ? "unfinished" : "completed",
                       truth::SecondsText(LengthOf(run), rate), LengthOf(run),
                       run.is_unfinished ? "; the recording does not say that it ended here" : "");
  std::string text =
      fmt::format("failed at {} s (tick {}): ", truth::SecondsText(status.tick, rate), status.tick);
  if (!status.entity.empty()) text += status.entity + ": ";
  text += status.reason;
  if (!status.advice.empty()) text += "; " + status.advice;
  return text;
}

std::string RunTable(const RunResult& run) {
  std::size_t role_columns = 1;
  for (const NamedEvent& event : run.timeline.events)
    role_columns = std::max(role_columns, event.roles.size());
  std::vector<std::vector<std::string>> rows = {{"event", "begin_s", "end_s", "roles"}};
  for (const NamedEvent& event : run.timeline.events) {
    rows.push_back(truth::EventCells(event, run.timeline.ticks_per_second, role_columns));
    for (const grammar::NamedValue& value : event.values) {
      rows.back().push_back(value.name + "=" + truth::ValueText(value));
    }
  }
  std::string table = truth::AlignColumns(rows);
  table += StatusText(run) + "\n";
  if (!run.outcome.empty()) table += "outcome: " + run.outcome + "\n";
  return table;
}

std::vector<std::string> NoteLines(const scenario::Scenario& scenario, const RunResult& run) {
  std::vector<std::string> lines;
  for (const physics::ScriptNote& note : run.notes) {
    const auto& hands = scenario.scene.hands;
    // A damaged file may say anything.
    const std::string hand =
        note.hand.IsBelow(hands.size()) ? At(hands, note.hand).name + ": " : "";
    lines.push_back(fmt::format("note: {} s: {}{}",
                                truth::SecondsText(note.tick, run.timeline.ticks_per_second), hand,
                                note.text));
  }
  return lines;
}

std::string HashText(std::uint64_t hash) { return fmt::format("0x{:016x}", hash); }

RunHeading HeadingOf(const scenario::Scenario& scenario, const RunResult& run) {
  return {scenario.name, scenario.skill, scenario.grammar, NoteLines(scenario, run)};
}

OrderedJson RunJson(const RunHeading& heading, const RunResult& run) {
  OrderedJson json = {{"scenario", heading.name},
                      {"id", ScenarioId(heading.skill, heading.name)},
                      {"status", !Completed(run)     ? "failed"
                                 : run.is_unfinished ? "unfinished"
                                                     : "completed"},
                      {"ticks_per_second", run.timeline.ticks_per_second},
                      {"ticks", LengthOf(run)},
                      {"state_hash", HashText(run.state_hash)},
                      {"grammar", heading.grammar}};
  if (!Completed(run)) {
    json["failure"] = {{"tick", run.status.tick},
                       {"entity", run.status.entity},
                       {"reason", run.status.reason},
                       {"advice", run.status.advice}};
  }
  if (!run.outcome.empty()) json["outcome"] = run.outcome;
  if (!heading.notes.empty()) json["notes"] = heading.notes;
  json["events"] = truth::TimelineJson(run.timeline)["events"];
  return json;
}

Measurement Measure(const RunResult& run) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {.seconds = run.seconds,
          .simulated_s = truth::SecondsOf(run.ticks, run.timeline.ticks_per_second),
          .peak_memory_kib = usage.ru_maxrss};
}

std::string MeasurementText(const Measurement& measurement) {
  const RunSeconds& seconds = measurement.seconds;
  const auto share = [&](double part_s) {
    return seconds.total > 0 ? 100 * part_s / seconds.total : 0;
  };
  return fmt::format(
      "measured: {:.1f} times real time; physics {:.1f} %, sensing {:.1f} %, grammar {:.1f} % of "
      "{:.3f} s; peak memory {:.0f} MiB\n",
      seconds.total > 0 ? measurement.simulated_s / seconds.total : 0, share(seconds.physics),
      share(seconds.sensing), share(seconds.grammar), seconds.total,
      static_cast<double>(measurement.peak_memory_kib) / 1024);
}

OrderedJson MeasurementJson(const Measurement& measurement) {
  const RunSeconds& seconds = measurement.seconds;
  return {{"simulated_s", measurement.simulated_s},
          {"total_s", seconds.total},
          {"physics_s", seconds.physics},
          {"sensing_s", seconds.sensing},
          {"grammar_s", seconds.grammar},
          {"times_real_time", seconds.total > 0 ? measurement.simulated_s / seconds.total : 0},
          {"peak_memory_kib", measurement.peak_memory_kib}};
}

}  // namespace prehend::episode

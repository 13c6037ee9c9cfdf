// SPDX-License-Identifier: Apache-2.0
// prehend bench. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/command/command.h"
#include "harness/run/run_text.h"
#include "harness/speed/measure.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {
namespace {

/// 1234567 -> "1.23 M"
std::string Large(double value) {
  for (const auto& [unit, size] : {std::pair{" G", 1e9}, {" M", 1e6}, {" k", 1e3}}) {
    if (value >= size) return fmt::format("{:.3g}{}", value / size, unit);
  }
  return fmt::format("{:.3g}", value);
}

std::string OrDash(bool has, const std::string& text) { return has ? text : "-"; }

std::vector<std::string> Cells(const SpeedFigure& f) {
  return {f.what,
          fmt::format("{:.3g} ns", f.seconds / f.operations * 1e9),
          f.unit,
          Large(f.operations / f.seconds),
          OrDash(f.baseline_s > 0, fmt::format("{:.2f}", f.baseline_s / f.seconds)),
          OrDash(f.on_change_s > 0, fmt::format("{:.2f}", f.on_change_s / f.seconds)),
          OrDash(f.events > 0, Large(f.events / f.seconds)),
          OrDash(f.simulated_s > 0, Large(f.simulated_s / f.seconds)),
          OrDash(f.physics_s > 0, fmt::format("{:.2f} %", 100 * f.seconds / f.physics_s)),
          OrDash(f.bytes > 0, fmt::format("{:.0f}", f.bytes)),
          OrDash(f.baseline_s > 0, f.agrees ? HashText(f.hash) : "DIFFERS")};
}

OrderedJson FigureJson(const SpeedFigure& f) {
  OrderedJson json = {{"what", f.what},
                      {"unit", f.unit},
                      {"operations", f.operations},
                      {"seconds", f.seconds},
                      {"ns_per_operation", f.seconds / f.operations * 1e9},
                      {"operations_per_s", f.operations / f.seconds}};
  if (f.baseline_s > 0) {
    json["baseline_s"] = f.baseline_s;
    json["times_baseline"] = f.baseline_s / f.seconds;
    json["on_change_s"] = f.on_change_s;
    json["times_on_change"] = f.on_change_s / f.seconds;
    json["agrees_with_baseline"] = f.agrees;
  }
  if (f.events > 0) json["events_per_s"] = f.events / f.seconds;
  if (f.simulated_s > 0) json["times_real_time"] = f.simulated_s / f.seconds;
  if (f.physics_s > 0) json["share_of_physics"] = f.seconds / f.physics_s;
  if (f.bytes > 0) json["bytes"] = f.bytes;
  if (f.baseline_s > 0) json["hash"] = HashText(f.hash);
  return json;
}

ExitCode RunBench(const ParsedOptions& options, const CommandContext& context) {
  const Result<std::vector<SpeedFigure>> measured =
      MeasureSpeed(context.root, options.Has("--quick"));
  if (!measured) return Complain(context, measured.error());
  std::vector<std::vector<std::string>> rows = {
      {"what", "takes", "per", "per_second", "times_baseline", "times_on_change", "events/s",
       "times_real_time", "of_physics", "bytes", "result"}};
  OrderedJson list = OrderedJson::array();
  for (const SpeedFigure& figure : *measured) {
    rows.push_back(Cells(figure));
    list.push_back(FigureJson(figure));
  }
  if (options.Has("--json")) {
    context.out << OrderedJson{{"figures", list}}.dump(2) << "\n";
  } else {
    for (const std::string& line : AlignColumns(rows)) context.out << line << "\n";
    context.out
        << "On one core. times_baseline: speed relative to the same rules by hand, evaluated "
           "for each object in every frame; times_on_change: relative to those by hand, "
           "evaluated for an object when something about it changes. All recognise the "
           "same events in the same run. bytes: memory of the monitor after the run, per "
           "object (of bindings: per binding).\n";
  }
  const bool agrees = std::ranges::all_of(*measured, &SpeedFigure::agrees);
  if (agrees) return ExitCode::kAgrees;
  return Complain(context, ExitCode::kDiffers,
                  "the grammar and the rules by hand recognise different events");
}

}  // namespace

Command BenchCommand() {
  return {.name = "bench",
          .summary = "Measure how fast grammars are evaluated on this machine",
          .examples = {"bench", "bench --json"},
          .options = {{.name = "--quick",
                       .help = "do a fraction of the work: shows that it runs, not how fast"},
                      {.name = "--json", .help = "print one JSON object instead of a table"}},
          .run = RunBench};
}

}  // namespace prehend::harness

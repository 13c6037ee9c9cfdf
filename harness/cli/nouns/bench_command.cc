// SPDX-License-Identifier: Apache-2.0
// prehend grammar bench. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/cli/command/command.h"
#include "harness/measure/speed/measure.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::cli {
namespace {

/// 1234567 -> "1.23 M"
std::string Large(double value) {
  for (const auto& [unit, size] : {std::pair{" G", 1e9}, {" M", 1e6}, {" k", 1e3}}) {
    if (value >= size) return fmt::format("{:.3g}{}", value / size, unit);
  }
  return fmt::format("{:.3g}", value);
}

std::vector<std::string> Cells(const measure::SpeedFigure& f) {
  return {f.what,
          fmt::format("{:.3g} ns", f.seconds / f.operations * 1e9),
          f.unit,
          Large(f.operations / f.seconds),
          Large(f.events / f.seconds),
          Large(f.simulated_s / f.seconds),
          f.physics_s > 0 ? fmt::format("{:.2f} %", 100 * f.seconds / f.physics_s) : "-"};
}

nlohmann::ordered_json FigureJson(const measure::SpeedFigure& f) {
  nlohmann::ordered_json json = {{"what", f.what},
                                 {"unit", f.unit},
                                 {"operations", f.operations},
                                 {"seconds", f.seconds},
                                 {"ns_per_operation", f.seconds / f.operations * 1e9},
                                 {"operations_per_s", f.operations / f.seconds},
                                 {"events_per_s", f.events / f.seconds},
                                 {"times_real_time", f.simulated_s / f.seconds}};
  if (f.physics_s > 0) json["share_of_physics"] = f.seconds / f.physics_s;
  return json;
}

ExitCode RunBench(const ParsedOptions& options, const CommandContext& context) {
  const auto name = episode::FindEpisode(
      options.TextOr("EPISODE", "pick_and_place/milk_carton_wrap"), "", context.root);
  if (!name) return Complain(context, name.error());
  auto episode = episode::OpenEpisode(*name, {options.Text("--grammar"), {}}, context.root);
  if (!episode) return Complain(context, episode.error());
  std::vector<std::vector<std::string>> rows = {
      {"what", "takes", "per", "per_second", "events/s", "times_real_time", "of_physics"}};
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const measure::SpeedFigure& figure :
       measure::MeasureSpeed(*episode, options.Has("--quick"))) {
    rows.push_back(Cells(figure));
    list.push_back(FigureJson(figure));
  }
  if (options.Has("--json")) {
    context.out << nlohmann::ordered_json{{"figures", list}}.dump(2) << "\n";
  } else {
    for (const std::string& line : truth::AlignColumns(rows)) context.out << line << "\n";
    context.out << "On one core, in processor time, the best of several runs.\n";
  }
  return ExitCode::kAgrees;
}

}  // namespace

Command BenchCommand() {
  return {.name = "grammar bench",
          .summary = "Measure how fast a grammar is evaluated on this machine",
          .examples = {"grammar bench", "grammar bench take.jsonl --grammar my/rules.grammar",
                       "grammar bench --json"},
          .options = {Argument("EPISODE",
                               "a scenario, an episode file or a recording whose frames are "
                               "watched; default: milk_carton_wrap"),
                      GrammarOption(),
                      Flag("--quick", "one run instead of five: shows that it runs, not how fast"),
                      JsonOption()},
          .run = RunBench};
}

}  // namespace prehend::cli

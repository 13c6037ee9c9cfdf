// SPDX-License-Identifier: Apache-2.0
// yardsticks [--quick] [--json]: how fast the monitor is on this machine; each figure is the best
// of several runs. Code by hand for the same rules runs beside it, in every frame and on change;
// the ratios can be compared between machines. --quick does a fraction of the work: shows that it
// runs. Exit status 1 if the grammar and the code by hand recognise different events. docs/speed.md
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bench/yardsticks/four_automata.h"
#include "bench/yardsticks/resting_boxes.h"
#include "bench/yardsticks/workload.h"
#include "bench/yardsticks/worlds.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/episode/sense/sensing.h"
#include "harness/measure/speed/measure.h"
#include "harness/truth/timeline/event_text.h"
#include "physics/simulation.h"

namespace prehend::bench {
namespace {

struct Figure {
  std::string what;
  std::string unit;        ///< of one operation
  double operations = 0;   ///< in one run
  double seconds = 0;      ///< of one run
  double baseline_s = 0;   ///< of the automata by hand in every frame, same run; 0: there are none
  double on_change_s = 0;  ///< of the automata by hand on change, likewise
  double events = 0;       ///< in one run
  double simulated_s = 0;  ///< of one run; 0: the workload has no real time
  double physics_s = 0;    ///< of the world in one run; 0: there is no world
  double bytes = 0;        ///< of the monitor per object (of a binding: per binding) after the run;
                           ///< 0: not measured
  std::uint64_t hash = 0;  ///< of the recognised events; 0: there are none
  bool agrees = true;      ///< with the automata by hand
};

constexpr double kFrameRate_hz = kWorldRate_hz;
constexpr int kRuns = 5;
constexpr std::size_t kKeptSnapshots = 100;  // of 5,000 bodies 0.6 MB each

// That malloc has handed out now, in blocks of its own and from the system.
double BytesInUse() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

class Measuring {
 public:
  explicit Measuring(bool quick) : quick_(quick), program_(CompileFourRules()) {}

  int Frames(int frames) const { return quick_ ? std::max(2, frames / 50) : frames; }

  /// The four rules on a log, by the grammar and by hand in turns. An operation is that of the
  /// unit, in one frame; frames that are left out count.
  Figure Watch(std::string what, std::string unit, double operations, const ChangeLog& log,
               int warm_up) const {
    const auto frames = static_cast<double>(log.end_tick() - warm_up);
    Figure figure{
        .what = std::move(what), .unit = std::move(unit), .operations = operations * frames};
    figure.seconds = figure.baseline_s = figure.on_change_s =
        std::numeric_limits<double>::infinity();
    std::size_t uncounted = 0;
    while (log[uncounted].tick < warm_up) ++uncounted;
    for (int run = 0; run < (quick_ ? 1 : kRuns); ++run) {
      const double bytes_before = BytesInUse();
      grammar::Monitor monitor(program_, log.entity_table);
      const Watched by_grammar = WatchByGrammar(log, monitor, uncounted);
      figure.bytes = (BytesInUse() - bytes_before) /
                     (static_cast<double>(log.entity_table.entities.size()) / 2);
      const Watched by_hand = WatchByHand(log, ByHand::kEveryFrame, uncounted);
      const Watched on_change = WatchByHand(log, ByHand::kOnChange, uncounted);
      figure.seconds = std::min(figure.seconds, by_grammar.seconds);
      figure.baseline_s = std::min(figure.baseline_s, by_hand.seconds);
      figure.on_change_s = std::min(figure.on_change_s, on_change.seconds);
      figure.agrees = figure.agrees && by_grammar.recognised == by_hand.recognised &&
                      by_grammar.recognised == on_change.recognised;
      figure.hash = by_grammar.recognised.hash;
      figure.events = static_cast<double>(by_grammar.events);
    }
    figure.simulated_s = frames / kFrameRate_hz;
    return figure;
  }

  Figure Stations(int objects, int frames, int warm_up, double period_s) const {
    warm_up = Frames(warm_up);
    return Watch(fmt::format("four rules, {} object{}, each used every {} s", objects,
                             objects == 1 ? "" : "s", period_s),
                 "object-rule-frame", static_cast<double>(FourRules::kCount * objects),
                 MakeStations(objects, Frames(frames) + warm_up, period_s), warm_up);
  }

  Figure WithoutEmptyFrames() const {
    const int warm_up = Frames(2400);
    return Watch("the same, without the frames that bring nothing", "object-rule-frame",
                 FourRules::kCount,
                 LeaveOutEmptyFrames(MakeStations(1, Frames(1'000'000) + warm_up, 10)), warm_up);
  }

  /// All facts about all objects change, each once in that many frames.
  Figure Dense(int objects, int every) const {
    return Watch(fmt::format("four rules, {} objects, a fact of each changes every {} frames",
                             objects, every),
                 "object-rule-frame", static_cast<double>(FourRules::kCount * objects),
                 MakeFlicker(objects, Frames(4000), objects / every, Flicker::kFact), 1);
  }

  Figure Touches(std::string what, std::string unit, Flicker flicker) const {
    constexpr int kObjects = 64, kPerFrame = 64;
    Figure figure = Watch(std::move(what), std::move(unit), kPerFrame,
                          MakeFlicker(kObjects, Frames(20'000), kPerFrame, flicker), 1);
    figure.simulated_s = figure.bytes = 0;
    return figure;
  }

  Figure Idle(int objects) const {
    const int frames = Frames(1'000'000);
    const ChangeLog log = MakeStations(objects, 1, 10);
    grammar::Monitor monitor(program_, log.entity_table);
    std::vector<grammar::Event> events;
    monitor.AdvanceBy(log[0], events);
    grammar::Tick tick = 1;
    for (; tick < 1000; ++tick)
      monitor.AdvanceBy({.tick = tick}, events);  // new instances become idle
    const measure::Stopwatch watch;
    for (int i = 0; i < frames; ++i) monitor.AdvanceBy({.tick = tick++}, events);
    return {.what = fmt::format("nothing changes, {} objects stand on a table", objects),
            .unit = "idle tick",
            .operations = static_cast<double>(frames),
            .seconds = watch.seconds(),
            .simulated_s = frames / kFrameRate_hz};
  }

  Figure Binding() const {
    const ChangeLog log = MakeStations(Frames(16'000), 1, 10);
    Figure figure{.what = "rules are bound to objects",
                  .unit = "binding",
                  .seconds = std::numeric_limits<double>::infinity()};
    for (int run = 0; run < kRuns; ++run) {
      std::vector<grammar::Event> events;
      const double bytes_before = BytesInUse();
      const measure::Stopwatch watch;
      grammar::Monitor monitor(program_, log.entity_table);
      monitor.AdvanceBy(log[0], events);
      figure.seconds = std::min(figure.seconds, watch.seconds());
      figure.operations = monitor.instances_in_use();
      figure.bytes = (BytesInUse() - bytes_before) / figure.operations;
    }
    return figure;
  }

 private:
  bool quick_;
  std::shared_ptr<const grammar::Program> program_;
};

// Thousands of boxes at rest: the cost of the world, and of sensing and grammar.
Figure WatchSleepers(std::shared_ptr<const grammar::Program> program, bool quick) {
  constexpr int kRate_hz = 60;  // falling asleep takes 2 s at any rate
  const int boxes = quick ? 50 : 5000, ticks = quick ? 20 : 400;
  const scenario::Scenario scenario = BoxesOnAFloor(boxes, kRate_hz);
  physics::Simulation simulation(scenario.scene, scenario.script);
  episode::Sensing sensing(scenario.scene, scenario.sensing);
  grammar::Monitor monitor(std::move(program), episode::MakeEntityTable(scenario));
  std::vector<grammar::Event> events;
  while (simulation.snapshot().tick < kUntilAsleep_s * kRate_hz && simulation.Step())
    monitor.AdvanceBy(sensing.SenseChanges(simulation.snapshot()), events);

  Figure figure{.what = fmt::format("pick_and_place, {} boxes asleep, sensing included", boxes),
                .unit = "physics tick"};
  figure.operations = ticks;
  figure.simulated_s = figure.operations / kRate_hz;
  std::vector<physics::Snapshot> recording;
  measure::Stopwatch watch;
  for (int i = 0; i < ticks; ++i) {
    simulation.Step();
    if (!sensing.Due(simulation.snapshot().tick) || recording.size() >= kKeptSnapshots) continue;
    figure.physics_s += watch.seconds();  // without the copies
    recording.push_back(simulation.snapshot());
    watch.Restart();
  }
  figure.physics_s += watch.seconds();
  watch.Restart();
  for (const physics::Snapshot& snapshot : recording)
    monitor.AdvanceBy(sensing.SenseChanges(snapshot), events);
  figure.seconds = watch.seconds() * ticks / 2 / static_cast<double>(recording.size());
  return figure;
}

std::vector<Figure> Measure(bool quick) {
  const Measuring measuring(quick);
  return {
      measuring.Stations(1, 1'000'000, 2400, 10),
      measuring.WithoutEmptyFrames(),
      measuring.Stations(1024, 4800, 2400, 10),
      measuring.Stations(1024, 14'400, 14'400, 60),
      measuring.Stations(4096, 4800, 14'400, 60),
      measuring.Stations(65'536, 480, 100, 60),
      measuring.Dense(1024, 8),
      measuring.Idle(65'536),
      measuring.Touches("a touch changes, no threshold is crossed", "change", Flicker::kPressure),
      measuring.Touches("a touch makes a condition true or false", "fact edge", Flicker::kFact),
      measuring.Touches("a touch begins or ends a grasp", "event boundary", Flicker::kGrasp),
      measuring.Binding(),
      WatchSleepers(episode::LoadGrammar(PREHEND_SOURCE_DIR, "pick_and_place", {}).program, quick)};
}

/// 1234567 -> "1.23 M"
std::string Large(double value) {
  for (const auto& [unit, size] : {std::pair{" G", 1e9}, {" M", 1e6}, {" k", 1e3}}) {
    if (value >= size) return fmt::format("{:.3g}{}", value / size, unit);
  }
  return fmt::format("{:.3g}", value);
}

std::string OrDash(bool has, const std::string& text) { return has ? text : "-"; }

std::vector<std::string> Cells(const Figure& f) {
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
          OrDash(f.baseline_s > 0, f.agrees ? episode::HashText(f.hash) : "DIFFERS")};
}

nlohmann::ordered_json FigureJson(const Figure& f) {
  nlohmann::ordered_json json = {{"what", f.what},
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
  if (f.baseline_s > 0) json["hash"] = episode::HashText(f.hash);
  return json;
}

int Run(const std::vector<std::string>& arguments) {
  const auto has = [&](const char* option) {
    return std::ranges::find(arguments, option) != arguments.end();
  };
  for (const std::string& argument : arguments) {
    if (argument == "--quick" || argument == "--json") continue;
    const bool asks = argument == "--help" || argument == "-h";
    fmt::print(asks ? stdout : stderr, "{}usage: yardsticks [--quick] [--json]   (docs/speed.md)\n",
               asks ? "" : fmt::format("yardsticks: found '{}'\n", argument));
    return asks ? 0 : 2;
  }
  const std::vector<Figure> figures = Measure(has("--quick"));
  std::vector<std::vector<std::string>> rows = {
      {"what", "takes", "per", "per_second", "times_baseline", "times_on_change", "events/s",
       "times_real_time", "of_physics", "bytes", "result"}};
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Figure& figure : figures) {
    rows.push_back(Cells(figure));
    list.push_back(FigureJson(figure));
  }
  if (has("--json"))
    std::puts(nlohmann::ordered_json{{"figures", list}}.dump(2).c_str());
  else
    std::fputs(truth::AlignColumns(rows).c_str(), stdout);
  return std::ranges::all_of(figures, &Figure::agrees) ? 0 : 1;
}

}  // namespace
}  // namespace prehend::bench

int main(int argc, char** argv) { return prehend::bench::Run({argv + 1, argv + argc}); }

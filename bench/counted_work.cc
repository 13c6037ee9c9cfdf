// SPDX-License-Identifier: Apache-2.0
// counted_work KIND FRAMES: does one of the workloads of docs/speed.md once and prints
// "operations allocations" of the part that is counted. What it costs in instructions is counted
// from outside, as the difference of two lengths: tests/bench/pinned_costs.
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <vector>

#include "bench/yardsticks/workload.h"
#include "bench/yardsticks/worlds.h"

namespace {
long allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace prehend::bench {
namespace {

constexpr int kFlickers = 64;

ChangeLog Stations(int frames) { return MakeStations(64, frames, 10); }

/// By name: its log, and operations per frame.
struct Work {
  std::function<ChangeLog(int)> log;
  double per_frame = 1;
};

const std::map<std::string, Work>& Works() {
  const auto flicker = [](Flicker kind) {
    return Work{[=](int frames) { return MakeFlicker(kFlickers, frames, kFlickers, kind); },
                kFlickers};
  };
  static const std::map<std::string, Work> works = {
      {"visit", {Stations, 64 / (10.0 * kWorldRate_hz)}},
      {"change", flicker(Flicker::kPressure)},
      {"edge", flicker(Flicker::kFact)},
      {"boundary", flicker(Flicker::kGrasp)},
      {"idle", {[](int) { return MakeStations(64, 1, 10); }}},
  };
  return works;
}

int Run(const std::string& kind, int frames) {
  const Work& work = Works().at(kind);
  const ChangeLog log = work.log(frames);
  std::vector<grammar::Event> events;
  events.reserve(1 << 20);
  grammar::Monitor monitor(CompileFourRules(), log.entity_table);
  const long before = allocations;
  for (std::size_t i = 0; i < log.size(); ++i) monitor.AdvanceBy(log[i], events);
  if (kind == "idle")
    for (int tick = 1; tick < frames; ++tick) monitor.AdvanceBy({.tick = tick}, events);
  std::printf("%.1f %ld\n", work.per_frame * frames, allocations - before);
  return 0;
}

}  // namespace
}  // namespace prehend::bench

int main(int argc, char** argv) {
  if (argc != 3 || !prehend::bench::Works().contains(argv[1])) {
    std::fputs("usage: counted_work visit|change|edge|boundary|idle FRAMES\n", stderr);
    return 2;
  }
  return prehend::bench::Run(argv[1], std::atoi(argv[2]));
}

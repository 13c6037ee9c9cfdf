// SPDX-License-Identifier: Apache-2.0
#include "bench/yardsticks/workload.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "harness/episode/sense/episode_format.h"
#include "harness/measure/speed/measure.h"

namespace prehend::bench {
namespace {

constexpr std::string_view kRules = R"(
grammar four_rules

event grasping(hand: Hand, object: Movable)
  while trigger(hand) >= {grip_on} and sensor_sets(hand, object) >= {sides}

event supported(object: Movable, support: Thing)
  while touching(object, support) and up(object, support) >= {level}
  lasting {support_ms} ms

event unanswered(hand: Hand, object: Movable)
  from touching(hand, object) begins to grasping(hand, object) begins
  during touching(hand, object)
  lasting {unanswered_ms} ms

event picking_up(hand: Hand, object: Movable)
  from supported(object, any) ends
  to not in_sphere(position(object), position(object)@begin, {region_m} m) begins
  during grasping(hand, object)
)";

}  // namespace

std::shared_ptr<const grammar::Program> CompileFourRules() {
  using fmt::arg;
  const std::string text = fmt::format(
      kRules, arg("grip_on", FourRules::kGripOn), arg("sides", FourRules::kSides),
      arg("level", FourRules::kLevel), arg("support_ms", FourRules::kSupport_ms),
      arg("unanswered_ms", FourRules::kUnanswered_ms), arg("region_m", FourRules::kRegion_m));
  return grammar::Compile({"four_rules", text}, nullptr).program;
}

void Recognised::Add(int rule, int hand, int object, grammar::Interval interval) {
  ++events;
  std::uint64_t mixed = 0;
  for (const std::int64_t value : {std::int64_t{rule}, std::int64_t{hand}, std::int64_t{object},
                                   interval.begin, interval.end}) {
    mixed = (mixed ^ static_cast<std::uint64_t>(value + 7)) * 0x9E3779B97F4A7C15ULL;
    mixed ^= mixed >> 29;
  }
  hash += mixed;
}

Watched WatchByGrammar(const ChangeLog& log, grammar::Monitor& monitor, std::size_t warm_up) {
  Watched watched;
  Recognised& recognised = watched.recognised;
  measure::Stopwatch watch;
  std::uint64_t events_before = 0;
  std::vector<grammar::Event> events;
  const auto take = [&] {
    for (const grammar::Event& event : events) {
      // Rules are numbered in the order of the text, after `touching`; supported(object, support)
      // has no hand.
      const int rule = event.rule.number() - 1;
      const bool has_hand = rule != FourRules::kSupported;
      recognised.Add(rule, has_hand ? event.roles[0] : grammar::kNoEntity,
                     event.roles[has_hand ? 1 : 0], event.interval);
    }
    events.clear();
  };
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (i == warm_up) {
      events_before = recognised.events;
      watch.Restart();
    }
    monitor.AdvanceBy(log[i], events);
    if (!events.empty()) take();
  }
  watched.seconds = watch.seconds();
  watched.events = recognised.events - events_before;
  monitor.Finish(log.end_tick(), events);
  take();
  return watched;
}

}  // namespace prehend::bench

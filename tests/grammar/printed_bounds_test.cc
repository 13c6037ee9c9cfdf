// SPDX-License-Identifier: Apache-2.0
// How late events of the library are decided: never later than `prehend validate --grammar` prints,
// in worlds where anything may happen and hands and things are lost now and then.
#include <map>
#include <string>

#include "grammar/describe.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/random_world.h"

namespace prehend::grammar {
namespace {

const char* const kLibrary[] = {"pick_and_place",
                                "pick_and_place_from_motion",
                                "kitchen",
                                "handing_over",
                                "handing_over_from_motion",
                                "hand_actions",
                                "hand_actions_from_motion",
                                "robot_pick_and_place",
                                "original_2020"};

// Of those whose delay depends on nothing but themselves. A frame is at most 20 ticks long, and
// each of the waits may take one more.
TEST(PrintedBounds, NoEventIsDecidedLaterThanPrinted) {
  constexpr Tick kFrames_ticks = 4 * 20;
  int judged = 0;
  for (const char* name : kLibrary) {
    const auto program = testing::CompileLibrary(name);
    std::map<std::string, Wait> printed;
    for (const RuleDescription& rule : Describe(*program).rules) printed[rule.name] = rule.latency;
    for (int seed = 0; seed < 2; ++seed) {
      testing::RandomWorld world(static_cast<std::uint64_t>(seed));
      Monitor monitor(program, world.entity_table);
      std::vector<Event> events;
      for (int i = 0; i < 3000; ++i) monitor.Advance(world.Next(), events);
      ASSERT_EQ(monitor.error(), "") << name;
      for (const Event& event : events) {
        const Wait& wait = printed.at(program->rules[event.rule].name);
        if (!wait.until_end_of.empty()) continue;
        ++judged;
        EXPECT_LE(event.decided - event.interval.end,
                  static_cast<Tick>(1000 * wait.seconds) + kFrames_ticks)
            << name << ": " << program->rules[event.rule].name;
      }
    }
  }
  EXPECT_GT(judged, 1000) << judged;
}

}  // namespace
}  // namespace prehend::grammar

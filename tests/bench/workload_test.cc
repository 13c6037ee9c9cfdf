// SPDX-License-Identifier: Apache-2.0
// The speed figures measure the same thing twice: the grammar and the automata by hand recognise
// the same.
#include "bench/yardsticks/workload.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>

#include "bench/yardsticks/four_automata.h"
#include "bench/yardsticks/worlds.h"
#include "grammar/describe.h"

namespace prehend::bench {
namespace {

Recognised Watch(const ChangeLog& log) {
  grammar::Monitor monitor(CompileFourRules(), log.entity_table);
  const Recognised recognised = WatchByGrammar(log, monitor, log.size() / 2).recognised;
  EXPECT_EQ(monitor.error(), "");
  return recognised;
}

void ExpectSameByHand(const ChangeLog& log, const Recognised& by_grammar) {
  EXPECT_EQ(by_grammar, WatchByHand(log, ByHand::kEveryFrame).recognised);
  EXPECT_EQ(by_grammar, WatchByHand(log, ByHand::kOnChange).recognised);
}

TEST(Speed, GrammarAndAutomataByHandRecogniseTheSame) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const ChangeLog log = MakeStations(40, 5000, 3, seed);
    const Recognised by_grammar = Watch(log);
    EXPECT_GT(by_grammar.events, 900u);
    ExpectSameByHand(log, by_grammar);
    const ChangeLog fewer = LeaveOutEmptyFrames(log);
    EXPECT_LT(fewer.size(), log.size());
    EXPECT_EQ(by_grammar, Watch(fewer));
    ExpectSameByHand(fewer, by_grammar);
  }
  for (const Flicker flicker : {Flicker::kPressure, Flicker::kFact, Flicker::kGrasp}) {
    const ChangeLog log = MakeFlicker(10, 200, 3, flicker);
    const Recognised by_grammar = Watch(log);
    ExpectSameByHand(log, by_grammar);
    EXPECT_EQ(by_grammar.events, flicker == Flicker::kGrasp ? 300u : 10u);
  }
}

// What docs/speed.md promises. Sanitizers bring an allocator of their own, which counts nothing.
TEST(Speed, AnObjectTakesFourKilobytesAfterUse) {
  constexpr int kObjects = 256;
  const ChangeLog log = MakeStations(kObjects, 16'000, 60);
  const std::size_t before = mallinfo2().uordblks;
  grammar::Monitor monitor(CompileFourRules(), log.entity_table);
  EXPECT_GT(WatchByGrammar(log, monitor).recognised.events, 4u * kObjects);
  const std::size_t after = mallinfo2().uordblks;
  EXPECT_LT(after - std::min(before, after), 4096u * kObjects);
}

// What `prehend validate` prints: bindings that are new, and after each object was used.
TEST(Speed, NoBindingTakesMoreThanIsPrinted) {
  const auto program = CompileFourRules();
  std::size_t bound = 0;
  for (const grammar::RuleDescription& rule : Describe(*program).rules)
    bound = std::max(bound, rule.bytes_per_binding + 2 * rule.bytes_per_interval);
  for (const int frames : {1, 16'000}) {
    const ChangeLog log = MakeStations(2048, frames, 60);
    std::vector<grammar::Event> events;
    const std::size_t before = mallinfo2().uordblks;
    grammar::Monitor monitor(program, log.entity_table);
    for (std::size_t i = 0; i < log.size(); ++i) {
      monitor.AdvanceBy(log[i], events);
      events.clear();
    }
    const std::size_t after = mallinfo2().uordblks;
    const auto bindings = static_cast<std::size_t>(monitor.instances_in_use());
    EXPECT_GT(bindings, 2000u);
    EXPECT_LE(after - std::min(before, after), bound * bindings + 100'000) << frames;
    std::printf("%zu bytes per binding, at most %zu\n", (after - before) / bindings, bound);
  }
}

TEST(Speed, TheHashSeesEveryPartOfAnEvent) {
  const auto hash = [](int rule, int hand, int object, grammar::Interval interval) {
    Recognised recognised;
    recognised.Add(rule, hand, object, interval);
    return recognised.hash;
  };
  const std::uint64_t one = hash(1, 2, 3, {4, 5});
  EXPECT_NE(one, hash(0, 2, 3, {4, 5}));
  EXPECT_NE(one, hash(1, 3, 2, {4, 5}));
  EXPECT_NE(one, hash(1, 2, 3, {4, 6}));
  EXPECT_NE(one, hash(1, 2, 3, {3, 5}));
}

}  // namespace
}  // namespace prehend::bench

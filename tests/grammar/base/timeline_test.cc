// SPDX-License-Identifier: Apache-2.0
#include "grammar/base/timeline.h"

#include <gtest/gtest.h>

#include "grammar/name_events.h"
#include "grammar/program/program.h"

namespace prehend::grammar {
namespace {

TEST(Timeline, NamesAndSortsEvents) {
  Program program;
  program.rules.push_back({.name = "touching"});
  program.rules.push_back({.name = "grasping", .roles = {{"hand", "Hand"}, {"object", "Thing"}}});
  const EntityTable entity_table{.ticks_per_second = 240,
                                 .entities = {{.name = "milk"}, {.name = "right"}},
                                 .styles = {"wrap"}};
  const Timeline timeline = NameEvents(program, entity_table,
                                       {{.rule = RuleId(1),
                                         .roles = {1, 0, kNoEntity, kNoEntity},
                                         .interval = {20, 30},
                                         .decided = 31,
                                         .style = 0},
                                        {.rule = RuleId(1),
                                         .roles = {1, 0, kNoEntity, kNoEntity},
                                         .interval = {5, 9},
                                         .decided = 12,
                                         .open_end = true}});
  ASSERT_EQ(timeline.events.size(), 2u);
  EXPECT_EQ(timeline.ticks_per_second, 240);
  EXPECT_EQ(timeline.events[0].interval, (Interval{5, 9}));
  EXPECT_TRUE(timeline.events[0].open_end);
  EXPECT_EQ(timeline.events[1].Label(), "grasping(right, milk)");
  EXPECT_EQ(timeline.events[1].roles.back(), (Role{"style", "wrap"}));
  EXPECT_EQ(timeline.events[1].decided, 31);
}

}  // namespace
}  // namespace prehend::grammar

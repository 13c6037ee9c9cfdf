// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/scenario/resolve/resolve.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

/// A mug on a table, and the base classes in line 6.
Result<Scenario> ReadClasses(const std::string& classes) {
  return ReadScenarioText(
      "probe.yaml",
      "scenario: probe\nshows: probe\nentities:\n"
      "  table: {class: Table, fixed: true, box: {size_m: [1, 1, 0.1]}, at_m: [0, 0, 0.7]}\n"
      "  mug: {class: Mug, box: {size_m: [0.1, 0.1, 0.1]}, mass_kg: 0.1, on: table, at_m: [0, 0]}\n"
      "classes: " +
          classes + "\n",
      {}, ProbeLibrary());
}

TEST(Kinds, AMugIsACupIsAContainer) {
  const auto read = ReadClasses("{Mug: Cup, Cup: Container}");
  ASSERT_TRUE(read) << Brief(ErrorsOf(read));
  const grammar::EntityTable entity_table = episode::MakeEntityTable(*read);
  EXPECT_EQ(entity_table.entities[0].classes,
            (std::vector<std::string>{"Table", "Fixed", "Thing", "Entity"}));
  EXPECT_EQ(entity_table.entities[1].classes,
            (std::vector<std::string>{"Mug", "Cup", "Container", "Movable", "Thing", "Entity"}));
}

TEST(Kinds, MistakesHaveTheirPlace) {
  EXPECT_EQ(Brief(ErrorsOf(ReadClasses("{Mag: Cup}"))),
            "6:11: classes: no entity has the class 'Mag' | did you mean 'Mug'?\n");
  EXPECT_EQ(Brief(ErrorsOf(ReadClasses("{Zebra: Mug, Yak: Mug}"))),
            "6:11: classes: no entity has the class 'Zebra' | known: Mug, Table\n6:23: classes: no "
            "entity has the class 'Yak' | known: Mug, Table\n");
  EXPECT_EQ(Brief(ErrorsOf(ReadClasses("{Mug: Cup, Cup: Mug}"))),
            "6:16: classes: 'Mug' is, directly or not, its own base class\n6:26: classes: 'Cup' "
            "is, directly or not, its own base class\n");
  EXPECT_EQ(Brief(ErrorsOf(ReadClasses("{Mug: Movable}"))),
            "6:16: classes: 'Movable' is a built-in class | declare your own classes, for example "
            "'Cup: Container'\n");
  EXPECT_EQ(Brief(ErrorsOf(ReadClasses("{Mug: cup}"))),
            "6:16: Mug: expected a class name like 'MilkCarton', found 'cup' | write 'Cup': it "
            "begins with a capital letter\n");
}

}  // namespace
}  // namespace prehend::scenario

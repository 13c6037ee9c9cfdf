// SPDX-License-Identifier: Apache-2.0
#include "harness/check/select_scenarios.h"

#include <gtest/gtest.h>

namespace prehend::harness {
namespace {

TEST(Shard, IsReadStrictly) {
  const auto shard = ParseShard("2/3");
  ASSERT_TRUE(shard);
  EXPECT_EQ(shard->number, 2);
  EXPECT_EQ(shard->count, 3);
  for (const char* bad : {"", "1", "1/", "/2", "0/2", "3/2", "1/0", "-1/2", "1/2/3", "a/b", "1 /2",
                          "1/99999999999", "1/100000"}) {
    EXPECT_FALSE(ParseShard(bad)) << bad;
  }
}

TEST(Shard, EveryScenarioIsInExactlyOne) {
  std::vector<std::string> kept;
  for (int number = 1; number <= 3; ++number) {
    ScenarioSelection selection;
    for (const char* name : {"a", "b", "c", "d"}) selection.scenarios.push_back({"s", name, name});
    selection.orphans = {{"s/gone", {}}};
    KeepShard({number, 3}, selection);
    EXPECT_EQ(selection.orphans.size(), number == 1 ? 1u : 0u);
    for (const ScenarioFile& file : selection.scenarios) kept.push_back(file.name);
  }
  EXPECT_EQ(kept, (std::vector<std::string>{"a", "d", "b", "c"}));
}

}  // namespace
}  // namespace prehend::harness

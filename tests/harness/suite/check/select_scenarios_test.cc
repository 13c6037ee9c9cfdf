// SPDX-License-Identifier: Apache-2.0
// Which scenarios patterns, filters and shards select, and what is said when there are none.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "harness/base/base/atomic_file.h"
#include "harness/suite/check/run_suite.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

class SelectScenariosTest : public testing::Test {
 protected:
  SelectScenariosTest() {
    fs::create_directories(root_);
    for (const char* library : {"grammar", "physics"})
      fs::create_directory_symlink(fs::path(PREHEND_SOURCE_DIR) / library, root_ / library);
    Write("slide/cup_slides", "smoke");
    Write("slide/mug_slides", "quick");
    Write("reach/cup_is_reached", "smoke");
  }
  ~SelectScenariosTest() override { fs::remove_all(root_); }

  void Write(const std::string& id, const std::string& tag) const {
    const std::string name = fs::path(id).filename().string();
    EXPECT_EQ(WriteTextFile(root_ / "scenarios" / (id + ".yaml"),
                            "scenario: " + name + "\nshows: a table\ntags: [" + tag +
                                "]\nentities:\n  table: {class: Table, fixed: true, box: {size_m: "
                                "[1, 1, 0.04]}, at_m: [0, 0, 0.7]}\nsettle_s: 0.1\n"),
              "");
  }

  /// Ids, or the problem.
  std::vector<std::string> Selected(const std::vector<std::string>& patterns,
                                    const std::vector<std::string>& filters = {}) const {
    const auto selection = SelectScenarios(patterns, filters, root_.string());
    if (!selection) return {selection.error().why};
    std::vector<std::string> ids;
    for (const episode::ScenarioFile& file : selection->scenarios)
      ids.push_back(episode::IdOf(file));
    return ids;
  }

  using Ids = std::vector<std::string>;
  const fs::path root_ =
      fs::path(testing::TempDir()) / ("select_scenarios_" + std::to_string(getpid()));
};

TEST_F(SelectScenariosTest, NothingMeansAll) {
  EXPECT_EQ(Selected({}), Ids({"reach/cup_is_reached", "slide/cup_slides", "slide/mug_slides"}));
}

TEST_F(SelectScenariosTest, PatternsMatchNamesAndIdsEachScenarioOnce) {
  EXPECT_EQ(Selected({"cup*"}), Ids({"reach/cup_is_reached", "slide/cup_slides"}));
  EXPECT_EQ(Selected({"slide/*", "mug_slides"}), Ids({"slide/cup_slides", "slide/mug_slides"}));
}

TEST_F(SelectScenariosTest, EveryFilterMustHold) {
  EXPECT_EQ(Selected({}, {"tag:smoke"}), Ids({"reach/cup_is_reached", "slide/cup_slides"}));
  EXPECT_EQ(Selected({}, {"tag:smoke", "!reach/*"}), Ids({"slide/cup_slides"}));
  EXPECT_EQ(Selected({"slide/*"}, {"!tag:smoke"}), Ids({"slide/mug_slides"}));
}

TEST_F(SelectScenariosTest, AFileOutsideTheProjectIsSelectedByItsPath) {
  const fs::path elsewhere = root_ / "elsewhere.yaml";
  fs::copy_file(root_ / "scenarios/slide/cup_slides.yaml", elsewhere);
  EXPECT_EQ(Selected({elsewhere.string()}), Ids({elsewhere.string()}));
}

TEST_F(SelectScenariosTest, WhatMatchesNothingIsAProblemWithTheNearestName) {
  EXPECT_EQ(Selected({"cup_slide"}),
            Ids({"no scenario matches 'cup_slide'; did you mean 'cup_slides'? ('prehend list' "
                 "shows all)"}));
  EXPECT_EQ(Selected({"slide"}), Ids({"no scenario matches 'slide'; did you mean 'slide/*'? "
                                      "('prehend list' shows all)"}));
  EXPECT_EQ(Selected({}, {"tag:smok"}),
            Ids({"--filter: no scenario has the tag 'smok'; did you mean 'smoke'? ('prehend list' "
                 "shows all)"}));
  EXPECT_EQ(Selected({}, {"grasp/*"}),
            Ids({"--filter: no scenario matches 'grasp/*' ('prehend list' shows all)"}));
  EXPECT_EQ(Selected({}, {"!*"}), Ids({"no scenario is selected ('prehend list' shows all)"}));
}

TEST_F(SelectScenariosTest, GoldensWithoutAScenarioAreSelectedAsItWouldBe) {
  for (const char* id : {"slide/gone", "reach/left"})
    EXPECT_EQ(WriteTextFile(root_ / "golden" / (std::string(id) + ".timeline"), "# scenario: x\n"),
              "");
  const auto orphans = [&](const Ids& patterns, const Ids& filters) {
    const auto selection = SelectScenarios(patterns, filters, root_.string());
    Ids ids;
    for (const UnreferencedGolden& orphan :
         selection ? selection->orphans : std::vector<UnreferencedGolden>())
      ids.push_back(orphan.scenario);
    return ids;
  };
  EXPECT_EQ(orphans({}, {}), Ids({"reach/left", "slide/gone"}));
  EXPECT_EQ(orphans({"slide/*"}, {}), Ids({"slide/gone"}));
  EXPECT_EQ(orphans({"left"}, {}), Ids({"reach/left"})) << "and no scenario";
  EXPECT_EQ(orphans({"cup_slides"}, {}), Ids());
  EXPECT_EQ(orphans({}, {"reach/*"}), Ids({"reach/left"}));
  EXPECT_EQ(orphans({}, {"!reach/*"}), Ids({"slide/gone"}));
  EXPECT_EQ(orphans({}, {"tag:smoke"}), Ids()) << "it has no tags";
}

TEST(Shard, IsReadStrictly) {
  const auto shard = ParseShard("2/3");
  ASSERT_TRUE(shard);
  EXPECT_EQ(shard->number, 2);
  EXPECT_EQ(shard->count, 3);
  EXPECT_EQ(ParseShard("3/16:costs.json")->costs, "costs.json");
  for (const char* bad : {"", "1", "1/2:", "1/", "/2", "0/2", "3/2", "1/0", "-1/2", "1/2/3", "a/b",
                          "1 /2", "1/99999999999", "1/100000"}) {
    EXPECT_FALSE(ParseShard(bad)) << bad;
  }
}

TEST(Shard, EveryScenarioIsInExactlyOne) {
  std::vector<std::string> kept;
  for (int number = 1; number <= 3; ++number) {
    ScenarioSelection selection;
    for (const char* name : {"a", "b", "c", "d"}) selection.scenarios.push_back({"s", name, name});
    selection.orphans = {{"s/gone", {}}};
    KeepShard({number, 3}, *PartsOf({number, 3}, {"s/a", "s/b", "s/c", "s/d"}), selection);
    EXPECT_EQ(selection.orphans.size(), number == 1 ? 1u : 0u);
    for (const episode::ScenarioFile& file : selection.scenarios) kept.push_back(file.name);
  }
  EXPECT_EQ(kept, (std::vector<std::string>{"a", "d", "b", "c"}));
}

TEST(Shard, WithCostsEachGoesWhereLeastIs) {
  const fs::path file = fs::temp_directory_path() / ("prehend_costs_" + std::to_string(getpid()));
  WriteTextFile(file, R"({"a": 1, "b": 5, "c": 3, "d": 3})");
  // The dearest first: b to 1, c to 2, d to 2 (3 is less than 5), then e, of the mean, to 1 (5 is
  // less than 6), then a to 2.
  EXPECT_EQ(*PartsOf({1, 2, file}, {"a", "b", "c", "d", "e"}), (std::vector<int>{2, 1, 2, 2, 1}));
  // b is 5 of 12. With 4 parts the slowest is that of b, as with 3.
  std::string note;
  PartsOf({1, 3, file}, {"a", "b", "c", "d"}, &note);
  EXPECT_EQ(note, "");
  EXPECT_EQ(*PartsOf({1, 4, file}, {"a", "b", "c", "d"}, &note), (std::vector<int>{4, 1, 2, 3}));
  EXPECT_EQ(note, "--shard: b alone is 41.7 % of all costs: more than 3 parts end no sooner\n");
  note.clear();
  PartsOf({1, 4, file}, {}, &note);
  EXPECT_EQ(note, "");
  WriteTextFile(file, "[]");
  const auto none = PartsOf({1, 2, file}, {"a"});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().front().message.find("no file of costs"), std::string::npos);
  fs::remove(file);
}

}  // namespace
}  // namespace prehend::suite

// SPDX-License-Identifier: Apache-2.0
// Changes are found value by value.
#include "harness/suite/check/settings.h"

#include <gtest/gtest.h>

namespace prehend::suite {
namespace {

const Settings kBefore = {
    {"g.grammar", {{"reach_radius", "30 cm"}, {"still_for", "0.2 s"}}},
    {"x.yaml", {{"entities.milk.mass_kg", "0.4"}, {"entities.milk.at_m", "[0, 0]"}}},
    {"gone.yaml", {{"a", "1"}}}};

TEST(Settings, OnlyOtherValuesOfFilesThatBothHaveAreChanges) {
  EXPECT_TRUE(ChangesBetween(kBefore, kBefore).empty());
  Settings now = kBefore;
  now.erase("gone.yaml");
  now["new.yaml"]["a"] = "1";
  now["g.grammar"]["reach_radius"] = "20 cm";
  now["x.yaml"].erase("entities.milk.at_m");
  now["x.yaml"]["entities.milk.mass_kg"] = "8";
  now["x.yaml"]["entities.milk.color"] = "red";
  std::vector<std::string> texts;
  for (const SettingChange& change : ChangesBetween(kBefore, now))
    texts.push_back(ChangeText(change) +
                    (change.of == SettingChange::Of::kParameter ? " (parameter)" : ""));
  EXPECT_EQ(texts,
            (std::vector<std::string>{
                "`reach_radius` 30 cm -> 20 cm (parameter)", "`entities.milk.at_m` removed: [0, 0]",
                "`entities.milk.color` added: red", "`entities.milk.mass_kg` 0.4 -> 8"}));
}

TEST(Settings, AFileThatWasNotedWithoutClausesHasNoNewOnes) {
  Settings now = kBefore;
  now["g.grammar"]["carrying while"] = "while held";
  EXPECT_TRUE(ChangesBetween(kBefore, now).empty());
  Settings then = now;
  then["g.grammar"]["carrying while"] = "while held and lifted";
  ASSERT_EQ(ChangesBetween(then, now).size(), 1u);
  EXPECT_EQ(ChangeText(ChangesBetween(then, now)[0]), "rule `carrying`: `while ..` lost `lifted`");
}

TEST(Settings, ALawIsNoRule) {
  EXPECT_EQ(ChangeText({"g.grammar", "apart law", "up(a), down(a) do not overlap",
                        "up(a), down(a), held(a) do not overlap", SettingChange::Of::kClause}),
            "law `apart`: gained `held(a)`");
}

TEST(Settings, PathsAreThoseOfTheProject) {
  EXPECT_EQ(RelativeTo("/root", "/root/scenarios/x.yaml"), "scenarios/x.yaml");
  EXPECT_EQ(RelativeTo("/root", "/elsewhere/x.yaml"), "/elsewhere/x.yaml");
}

}  // namespace
}  // namespace prehend::suite

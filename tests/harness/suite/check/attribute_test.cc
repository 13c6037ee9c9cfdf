// SPDX-License-Identifier: Apache-2.0
// A difference belongs to the change without which it is not there.
#include <gtest/gtest.h>

#include "harness/suite/check/settings.h"

namespace prehend::suite {
namespace {

grammar::NamedEvent Event(const std::string& name, grammar::Tick begin, grammar::Tick end) {
  return {.event = name, .roles = {{"hand", "h"}, {"object", "cup"}}, .interval = {begin, end}};
}

truth::Comparison ComparedWith(const std::vector<grammar::NamedEvent>& recognised) {
  truth::Golden golden{.scenario = "s/x", .grammar = "g", .ticks_per_second = 100};
  for (const auto& event :
       {Event("reaching", 0, 100), Event("sliding", 100, 200), Event("grasping", 200, 300)})
    golden.events.push_back({.event = event, .tolerance_ms = {}, .because = {}, .comments = {}});
  return truth::Compare(golden, {.ticks_per_second = 100, .events = recognised}, 2);
}

const grammar::NamedEvent kLateReach = Event("reaching", 20, 100);
const grammar::NamedEvent kReach = Event("reaching", 0, 100);
const grammar::NamedEvent kSlide = Event("sliding", 100, 200);
const grammar::NamedEvent kEarlyGrasp = Event("grasping", 190, 290);

const PossibleCauses kThreeChanges = {
    .changes = {{"a.grammar", "reach_radius", "30 cm", "20 cm", SettingChange::Of::kParameter},
                {"a.grammar", "slide_distance", "2 cm", "5 cm", SettingChange::Of::kParameter},
                {"x.yaml", "cup.mass_kg", "0.4", "8"}},
    .other_changes = {},
    .motion_differs = true};

/// The late reach and the lost slide follow from the two parameters, the grasp from neither.
std::optional<truth::Comparison> Undone(const std::vector<const SettingChange*>& undone) {
  std::vector<grammar::NamedEvent> recognised = {kEarlyGrasp};
  const auto has = [&](const char* name) {
    return std::ranges::any_of(undone, [&](const auto* one) { return one->name == name; });
  };
  recognised.push_back(has("reach_radius") ? kReach : kLateReach);
  if (has("slide_distance")) recognised.push_back(kSlide);
  return ComparedWith(recognised);
}

std::vector<std::string> Texts(const std::vector<Attribution>& attributions) {
  std::vector<std::string> texts;
  for (const Attribution& each : attributions)
    texts.push_back(each.event + " " + each.what + ": " + each.because);
  std::sort(texts.begin(), texts.end());
  return texts;
}

TEST(Attribution, ToldApartInOneScenario) {
  EXPECT_EQ(Texts(AttributeDifferences(*Undone({}), kThreeChanges, Undone)),
            (std::vector<std::string>{
                "grasping begins and ends earlier: `cup.mass_kg` 0.4 -> 8 in x.yaml",
                "reaching begins later: `reach_radius` 30 cm -> 20 cm in a.grammar",
                "sliding missing: `slide_distance` 2 cm -> 5 cm in a.grammar"}));
}

TEST(Attribution, TheShiftIsOfTheBoundaryThatIsNamedFirst) {
  for (const auto& [begin, end, what, shift_ms] :
       {std::tuple(25, 95, "begins later (and ends earlier)", 250.0),
        {5, 75, "ends earlier (and begins later)", -250.0},
        {25, 75, "begins later (and ends earlier)", 250.0}}) {
    const Attribution told = AttributeDifferences(
        ComparedWith({Event("reaching", begin, end), kSlide, Event("grasping", 200, 300)}), {},
        {})[0];
    EXPECT_EQ(told.what, what);
    EXPECT_EQ(told.shift_ms, shift_ms);
  }
}

TEST(Attribution, TwoParametersTogether) {
  const auto both_needed = [](const std::vector<const SettingChange*>& undone) {
    return std::optional(undone.size() == 2
                             ? ComparedWith({kReach, kSlide, Event("grasping", 200, 300)})
                             : ComparedWith({kLateReach, kSlide, Event("grasping", 200, 300)}));
  };
  EXPECT_EQ(Texts(AttributeDifferences(*both_needed({}), kThreeChanges, both_needed)),
            (std::vector<std::string>{"reaching begins later: `reach_radius` 30 cm -> 20 cm, "
                                      "`slide_distance` 2 cm -> 5 cm in a.grammar"}));
}

TEST(Attribution, AClauseIsACauseByItself) {
  PossibleCauses changes = kThreeChanges;
  changes.changes[1] = {"a.grammar", "sliding while", "while a and b", "while a",
                        SettingChange::Of::kClause};
  const auto without = [](const std::vector<const SettingChange*>& undone) {
    const bool has_both = undone.size() == 1 && undone[0]->of == SettingChange::Of::kClause;
    return std::optional(has_both ? ComparedWith({kLateReach, kSlide})
                                  : ComparedWith({kLateReach}));
  };
  const auto texts = Texts(AttributeDifferences(*without({}), changes, without));
  EXPECT_EQ(texts.back(), "sliding missing: rule `sliding`: `while ..` lost `b` in a.grammar");
}

TEST(Attribution, OfSeveralTogetherThoseThatAreNeeded) {
  PossibleCauses changes = kThreeChanges;
  changes.changes[2] = {"a.grammar", "lifting while", "while a", "while b",
                        SettingChange::Of::kClause};
  const auto without = [](const std::vector<const SettingChange*>& undone) {
    const auto has = [&](const char* name) {
      return std::ranges::any_of(undone, [&](const auto* one) { return one->name == name; });
    };
    const bool holds = has("reach_radius") && has("lifting while");
    return std::optional(
        ComparedWith({holds ? kReach : kLateReach, kSlide, Event("grasping", 200, 300)}));
  };
  EXPECT_EQ(Texts(AttributeDifferences(*without({}), changes, without)),
            (std::vector<std::string>{"reaching begins later: `reach_radius` 30 cm -> 20 cm, "
                                      "rule `lifting`: `while ..` `a` -> `b` in a.grammar"}));
}

TEST(Attribution, ClausesOfARuleGoTogether) {
  const auto clause = [](const char* name) {
    return SettingChange{"a.grammar", name, "a(x)", "a(y)", SettingChange::Of::kClause};
  };
  const PossibleCauses changes = {
      .changes = {clause("lifting while"), clause("sliding roles"), clause("sliding while")}};
  const auto without = [](const std::vector<const SettingChange*>& undone) {
    const bool is_whole = undone.size() >= 2 && undone[undone.size() - 2]->name == "sliding roles";
    return std::optional(is_whole ? ComparedWith({kReach, kSlide, Event("grasping", 200, 300)})
                                  : ComparedWith({kReach, Event("grasping", 200, 300)}));
  };
  EXPECT_EQ(Texts(AttributeDifferences(*without({}), changes, without)),
            (std::vector<std::string>{"sliding missing: rule `sliding`: `a(x)` -> `a(y)`, "
                                      "rule `sliding`: `while ..` `a(x)` -> `a(y)` in a.grammar"}));
}

TEST(Attribution, OfAFailureThatIsNoDifference) {
  const auto only_slide = [](const std::vector<const SettingChange*>& undone) {
    return undone.size() == 1 && undone[0]->name == "slide_distance";
  };
  EXPECT_EQ(CauseOfFailure(kThreeChanges, only_slide),
            "`slide_distance` 2 cm -> 5 cm in a.grammar");
  EXPECT_EQ(CauseOfFailure(kThreeChanges, [](const auto&) { return false; }),
            "`cup.mass_kg` 0.4 -> 8 in x.yaml");
  EXPECT_EQ(CauseOfFailure(kThreeChanges, nullptr),
            "`reach_radius` 30 cm -> 20 cm, `slide_distance` 2 cm -> 5 cm in a.grammar, "
            "`cup.mass_kg` 0.4 -> 8 in x.yaml");
  PossibleCauses still = kThreeChanges;
  still.motion_differs = false;
  still.other_changes = {"the program"};
  EXPECT_EQ(CauseOfFailure(still, [](const auto&) { return false; }),
            CauseOfFailure(kThreeChanges, nullptr));
  EXPECT_EQ(CauseOfFailure({.changes = {}, .other_changes = {"a.grammar"}}, nullptr), "a.grammar");
}

TEST(Attribution, WithoutAChangedValueTheFileIsNamed) {
  const auto nothing = [](const std::vector<const SettingChange*>&) {
    return std::optional<truth::Comparison>();
  };
  const PossibleCauses file = {
      .changes = {}, .other_changes = {"a.grammar"}, .motion_differs = false};
  for (const Attribution& each : AttributeDifferences(*Undone({}), file, nothing))
    EXPECT_EQ(each.because, "a.grammar");
  for (const Attribution& each : AttributeDifferences(*Undone({}), PossibleCauses{}, nothing))
    EXPECT_EQ(each.because, "");
}

}  // namespace
}  // namespace prehend::suite

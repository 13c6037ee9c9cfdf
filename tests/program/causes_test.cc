// SPDX-License-Identifier: Apache-2.0
// Three faults in a copy of two skills' scenarios: `check` names them, with parameter and value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

TEST(Causes, ThreeSeededFaultsAreNamedWithTheirValues) {
  const fs::path root = FreshFolder("causes");
  for (const char* folder : {"grammar/library", "physics/library", "scenarios/slide",
                             "scenarios/reach", "golden/slide", "golden/reach"}) {
    fs::create_directories(root / folder);
    fs::copy(fs::path(PREHEND_SOURCE_DIR) / folder, root / folder, fs::copy_options::recursive);
  }
  const auto check = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"check", "--no-pictures"};
    words.insert(words.end(), more.begin(), more.end());
    return Prehend(words, {"PREHEND_HOME=" + root.string()});
  };
  ASSERT_EQ(check({}).exit_code, 0);

  // Of a recorded run nothing changed but what the command line says.
  const char* const hop = "slide/hop_divides_a_slide";
  const std::string kept = (root / "hop.episodes").string();
  ASSERT_EQ(Prehend({"run", hop, "--record", kept}, {"PREHEND_HOME=" + root.string()}).exit_code,
            0);
  const auto causes = [&](const std::string& what) {
    const std::string out = check({what, "--set", "slide_distance=50cm"}).out;
    EXPECT_NE(out.find("Changed since: --set slide_distance=50cm\n"), std::string::npos) << out;
    return out.substr(std::min(out.find("1 cause:"), out.size()),
                      out.find("     look:") - out.find("1 cause:"));
  };
  EXPECT_EQ(causes(kept), causes(hop));

  const auto change = [&](const char* file, const char* from, const char* to) {
    WriteFile(root / file, Replaced(ReadFile(root / file), from, to));
  };
  const char* const grammar = "grammar/library/pick_and_place.grammar";
  change(grammar, "param reach_radius = 30 cm", "param reach_radius = 20 cm");
  change(grammar, "param slide_distance = 2 cm", "param slide_distance = 5 cm");
  change("scenarios/slide/carton_slides_then_is_transported.yaml", "mass_kg: 0.4", "mass_kg: 8");
  const Said said = check({});
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_NE(said.out.find("3 causes:\n"
                          "1. `reach_radius` 30 cm -> 20 cm in "
                          "grammar/library/pick_and_place.grammar: "),
            std::string::npos)
      << said.out;
  EXPECT_NE(said.out.find(" x reaching begins later, median +"), std::string::npos) << said.out;
  for (const char* part :
       {"`slide_distance` 2 cm -> 5 cm in grammar/library/pick_and_place.grammar: "
        "2 scenarios\n     4 x sliding missing\n",
        "`entities.milk.mass_kg` 0.4 -> 8 in "
        "scenarios/slide/carton_slides_then_is_transported.yaml: "
        "slide/carton_slides_then_is_transported\n"})
    EXPECT_NE(said.out.find(part), std::string::npos) << said.out;
  EXPECT_EQ(said.out.find("facts at"), std::string::npos) << "one line for each of so many";

  // The page shows these lines; ".." stands for those left out.
  const std::string page = ReadFile(fs::path(PREHEND_SOURCE_DIR) / "docs/regression-suite.md");
  const std::size_t shown = page.find("3 causes:\n");
  std::istringstream lines(page.substr(shown, page.find("```", shown) - shown));
  for (std::string line; std::getline(lines, line);) {
    if (line == "     ..") continue;
    EXPECT_NE(said.out.find(line + "\n"), std::string::npos) << line << "\n" << said.out;
  }

  const auto json = nlohmann::json::parse(check({"--json", "slide/four*"}).out);
  EXPECT_EQ(json["causes"].size(), 2);
  EXPECT_EQ(json["causes"][0]["effects"][0]["count"], 1);

  // A clause that lost a condition, and a role that is another one, beside them.
  change(grammar,
         "picking_up(hand, object), putting_down(hand, object), hovering(hand, object)\n  drawn",
         "putting_down(hand, object), hovering(hand, object)\n  drawn");
  change(grammar, "= supported_by(object, any) or slipping",
         "= supported_by(any, object) or slipping");
  const Said rules = check({"slide/*"});
  EXPECT_EQ(rules.exit_code, 1);
  for (const char* part :
       {". rule `transporting`: `outside ..` lost `picking_up(hand, object)` in "
        "grammar/library/pick_and_place.grammar: ",
        "x transporting begins earlier",
        ". rule `landed`: `supported_by(object, any)` -> `supported_by(any, object)` in "
        "grammar/library/pick_and_place.grammar: ",
        "`slide_distance` 2 cm -> 5 cm in grammar/library/pick_and_place.grammar: "})
    EXPECT_NE(rules.out.find(part), std::string::npos) << part << "\n" << rules.out;
  EXPECT_EQ(rules.out.find(root.string() + "/grammar"), std::string::npos) << rules.out;

  const Said differ = Prehend({"grammar", "diff", "pick_and_place", (root / grammar).string()});
  EXPECT_EQ(differ.exit_code, 1);
  EXPECT_EQ(differ.out,
            "rule `landed`: `supported_by(object, any)` -> `supported_by(any, object)`\n"
            "`reach_radius` 30 cm -> 20 cm\n"
            "`slide_distance` 2 cm -> 5 cm\n"
            "rule `transporting`: `outside ..` lost `picking_up(hand, object)`\n");
  EXPECT_EQ(Prehend({"grammar", "diff", "contact", "contact"}).exit_code, 0);

  // What is no difference from a golden: a law that is violated, roles with which nothing compiles.
  const std::string good = ReadFile(fs::path(PREHEND_SOURCE_DIR) / grammar);
  const auto cause_of = [&](const char* from, const char* to, const char* scenario) {
    WriteFile(root / grammar, Replaced(good, from, to));
    const std::string out = check({scenario}).out;
    return out.substr(std::min(out.find("1 cause:"), out.size()));
  };
  EXPECT_THAT(cause_of("putting_down(hand, object)\n  do not overlap",
                       "putting_down(hand, object), grasping(hand, object)\n  do not overlap",
                       "slide/four_centimetres_are_a_slide"),
              testing::HasSubstr("1. law `phases_do_not_overlap`: gained `grasping(hand, object)` "
                                 "in grammar/library/pick_and_place.grammar: "));
  EXPECT_THAT(
      cause_of("landed(hand: Hand, object: Movable) =", "landed(object: Movable, hand: Hand) =",
               "slide/four_centimetres_are_a_slide"),
      testing::HasSubstr("1. rule `landed`: `landed(hand: Hand, object: Movable)` -> "
                         "`landed(object: Movable, hand: Hand)` in "));
}

}  // namespace
}  // namespace prehend::house

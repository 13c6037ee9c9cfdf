// SPDX-License-Identifier: Apache-2.0
// Laws of a grammar as a person meets them.
#include <regex>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

class Laws : public SmallProject {
 protected:
  void WriteGrammar(const std::string& text) const {
    WriteFile(root_ / "grammar/library/mine.grammar", "grammar mine\nuse contact\n" + text);
  }
};

TEST_F(Laws, ABrokenLawFailsACheckWhoseGoldenAgrees) {
  WriteGrammar("");
  Accept();
  EXPECT_EQ(Do("check --no-pictures --grammar mine").exit_code, 0);
  WriteGrammar(
      "# Not true: it stands on the table.\n"
      "law nothing_stands_on_what_it_touches(object: Movable, place: Thing)\n"
      "  supported_by(object, place), contact(object, place) do not overlap\n");
  const Said said = Do("check --no-pictures --grammar mine");
  EXPECT_EQ(said.exit_code, 1) << said.out << said.err;
  EXPECT_TRUE(std::regex_search(
      said.out,
      std::regex("violated: nothing_stands_on_what_it_touches at 0\\.0\\d+\\.\\.0\\.\\d+ s: "
                 "supported_by\\(carton, table\\) overlaps contact\\(carton, table\\)\n"
                 ".*mine\\.grammar:4: law nothing_stands_on_what_it_touches\\(object: Movable, "
                 "place: Thing\\) supported_by\\(object, place\\), contact\\(object, place\\) do "
                 "not overlap\n")))
      << said.out;
  EXPECT_NE(said.out.find("a law of the grammar is violated"), std::string::npos) << said.out;
}

// The library says that a slide lies inside a grasp: of its own `sliding`, not of any.
TEST_F(Laws, AreThoseOfTheGrammarThatWatches) {
  const std::string slides =
      "event sliding(object: Movable, support: Thing)\n  while supported_by(object, support)\n";
  WriteGrammar(slides);
  Said said = Do("check --no-pictures --grammar mine");
  EXPECT_EQ(said.exit_code, 5) << said.out << said.err;  // there is no golden, and nothing else
  EXPECT_EQ(said.out.find("violated"), std::string::npos) << said.out;
  WriteGrammar(slides +
               "law slides_are_caught(object: Movable, support: Thing)\n"
               "  sliding(object, support) meets contact(object, any Hand)\n");
  said = Do("check --no-pictures --grammar mine");
  EXPECT_EQ(said.exit_code, 1) << said.out << said.err;
  EXPECT_NE(said.out.find("sliding(carton, table) meets no contact(carton, any Hand)\n"),
            std::string::npos)
      << said.out;
}

TEST_F(Laws, AreListedWithTheRules) {
  WriteGrammar(
      "law a_law(object: Movable) rest of supported_by(object, any Table) outside "
      "contact(object, any) is empty\n");
  const Said said = Do("validate --grammar mine");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("\nlaw a_law(object: Movable)\n    rest of supported_by(object, any "
                          "Table) outside contact(object, any) is empty\n"),
            std::string::npos)
      << said.out;
}

}  // namespace
}  // namespace prehend::house

// SPDX-License-Identifier: Apache-2.0
// The failed test at the top of README.md, and the answers on pages of docs/, are what the program
// prints.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

/// What stands between "```text" and "```" for the nth time, from 0.
std::string TextBlock(const std::string& page, int nth) {
  const std::string begin = "```text\n";
  std::size_t at = 0;
  for (int i = 0; i <= nth; ++i) at = page.find(begin, at) + begin.size();
  return page.substr(at, page.find("```", at) - at);
}

TEST(Readme, ShowsAFailedTestAsItIsPrinted) {
  const fs::path root = FreshFolder("readme");
  for (const char* library : {"grammar/library", "physics/library"}) {
    fs::create_directories(root / library);
    fs::copy(fs::path(PREHEND_SOURCE_DIR) / library, root / library, fs::copy_options::recursive);
  }
  const std::string id = "slide/four_centimetres_are_a_slide";
  for (const auto& file : {"scenarios/" + id + ".yaml", "golden/" + id + ".timeline"})
    WriteFile(root / file, ReadFile(fs::path(PREHEND_SOURCE_DIR) / file));
  const std::vector<std::string> environment = {"PREHEND_HOME=" + root.string(),
                                                "PREHEND_COMMAND=./run"};
  ASSERT_EQ(Prehend({"check", "--no-pictures"}, environment).exit_code, 0);
  const fs::path grammar = root / "grammar/library/pick_and_place.grammar";
  WriteFile(grammar, Replaced(ReadFile(grammar), "slide_distance = 2 cm", "slide_distance = 5 cm"));

  std::string checked = Prehend({"check", "--no-pictures"}, environment).out;
  for (std::size_t at; (at = checked.find(root.string() + "/")) != checked.npos;)
    checked.erase(at, root.string().size() + 1);
  const std::string readme = ReadFile(fs::path(PREHEND_SOURCE_DIR) / "README.md");
  EXPECT_EQ(checked.substr(0, checked.find("1 cause:\n")), TextBlock(readme, 0));

  const std::string why = "--expected '";
  const std::size_t at = checked.find(why) + why.size();
  const std::string expected = checked.substr(at, checked.find('\'', at) - at);
  const std::string explained = Prehend({"explain", id, "--expected", expected}, environment).out;
  EXPECT_EQ(explained.substr(0, explained.find("\n\n") + 1), TextBlock(readme, 1));
}

std::string PageOfDocs(const char* name) {
  return ReadFile(fs::path(PREHEND_SOURCE_DIR) / "docs" / name);
}

TEST(DocumentOfExplain, ShowsAnswersAsTheyArePrinted) {
  const std::string page = PageOfDocs("explain.md"), id = "four_centimetres_are_a_slide";
  EXPECT_EQ(Prehend({"explain", id, "--event", "sliding"}).out, TextBlock(page, 0));
  const std::vector<std::string> words = {
      "explain", id, "--set", "slide_distance=30 cm", "--expected", "sliding@1.7s"};
  EXPECT_EQ(Prehend(words).out, TextBlock(page, 1));
}

TEST(DocumentOfFactsFromMotion, ShowsTheWarningAsItIsPrinted) {
  const fs::path docs = fs::path(PREHEND_SOURCE_DIR) / "docs/motion_capture";
  const std::string poses = (FreshFolder("facts_page") / "poses.jsonl").string();
  ASSERT_EQ(Prehend({"import", (docs / "poses.csv").string(), "--map",
                     (docs / "bodies.yaml").string(), "-o", poses})
                .exit_code,
            0);
  std::string told = Prehend({"episode", "resegment", poses, "--grammar", "pick_and_place"}).err;
  if (told.starts_with(PREHEND_SOURCE_DIR))
    told.erase(0, std::string(PREHEND_SOURCE_DIR).size() + 1);
  const std::string page = TextBlock(PageOfDocs("facts-from-motion.md"), 0);
  EXPECT_EQ(told, page.substr(page.find('\n') + 1));
}

TEST(DocumentOfTheFirstScenario, ItsLastQuestionIsTheOneThatCheckPrints) {
  const fs::path project = FreshFolder("first_scenario") / "mine";
  ASSERT_EQ(Prehend({"new", "--project", project.string()}).exit_code, 0);
  const std::vector<std::string> mine = {"PREHEND_HOME=" + project.string(),
                                         "PREHEND_COMMAND=./run", "CI="};
  ASSERT_EQ(Prehend({"new", "first/carton_is_lifted"}, mine).exit_code, 0);
  const Said accepted = Prehend({"accept", "carton_is_lifted", "--reason", "as its script"}, mine);
  ASSERT_EQ(accepted.exit_code, 0) << accepted.out << accepted.err;
  const std::string out =
      Prehend({"check", "carton_is_lifted", "--no-pictures", "--set", "lift_rise=30cm"}, mine).out;
  const std::size_t why = out.find("./run explain ");
  ASSERT_NE(why, std::string::npos) << out;
  const std::string page = PageOfDocs("first-scenario.md");
  EXPECT_NE(page.find(out.substr(why, out.find('\n', why) - why)), std::string::npos) << out;
  const std::string told = Prehend({"explain", "first/carton_is_lifted", "--set", "lift_rise=30cm",
                                    "--expected", "picking_up@1.4708s"},
                                   mine)
                               .out;
  EXPECT_NE(told.find("is 123 mm, 177 mm below 300 mm"), std::string::npos) << told;
}

TEST(Readme, ItsQuestionHasANumberForAnAnswer) {
  const std::string readme = ReadFile(fs::path(PREHEND_SOURCE_DIR) / "README.md"),
                    asks = "./run explain milk_carton_wrap --expected ";
  const std::size_t at = readme.find(asks);
  ASSERT_NE(at, std::string::npos);
  const std::size_t begin = at + asks.size();
  const Said said = Prehend({"explain", "milk_carton_wrap", "--expected",
                             readme.substr(begin, readme.find(' ', begin) - begin)});
  EXPECT_NE(said.out.find("\n    with "), std::string::npos) << said.out;
}

}  // namespace
}  // namespace prehend::house

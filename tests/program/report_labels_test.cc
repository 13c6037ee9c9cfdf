// SPDX-License-Identifier: Apache-2.0
// `report --truth`: labels, grammars and others on one page, as docs/labels.md says. What can be
// done there: tests/page/labels_test.mjs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class ReportLabels : public testing::Test {
 protected:
  ReportLabels() {
    const Said said = Prehend({"import", docs_ + "/poses.csv", "--map", docs_ + "/bodies.yaml",
                               "-o", Path("milk.jsonl")});
    EXPECT_EQ(said.exit_code, 0) << said.err;
  }
  ~ReportLabels() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  Said Report(std::vector<std::string> words) const {
    words.insert(words.begin(), {"report", Path("milk.jsonl")});
    words.insert(words.end(), {"-o", Path("page.html")});
    return Prehend(words);
  }
  std::string Page() const { return ReadFile(folder_ / "page.html"); }

  const std::string docs_ = PREHEND_SOURCE_DIR "/docs/motion_capture";
  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(ReportLabels, AgreementIsThatOfScore) {
  const std::vector<std::string> truth = {"--truth", docs_ + "/labels.csv", "--map",
                                          docs_ + "/labels.yaml"};
  const Said said = Report(truth);
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(Has(said.out, "page.html: 1 take, ")) << said.out;
  const std::string page = Page();
  EXPECT_TRUE(Has(page, "<h1>Comparison with labels</h1>"));
  EXPECT_TRUE(Has(page, "data-event=\"grasping(hand=right_hand, object=milk)\" data-lane=\"0\""));
  EXPECT_TRUE(Has(page, "data-event=\"grasping(hand=right_hand, object=milk)\" data-lane=\"1\""));
  EXPECT_FALSE(Has(page, "<video"));
  std::vector<std::string> score = {"score", Path("milk.jsonl"), "--json"};
  score.insert(score.end(), truth.begin(), truth.end());
  std::vector<std::string> as_json = truth;
  as_json.emplace_back("--json");
  const auto here = nlohmann::json::parse(Report(as_json).out);
  EXPECT_EQ(here["grammars"], nlohmann::json::parse(Prehend(score).out)["grammars"]);
  EXPECT_EQ(here["takes"], 1);
}

TEST_F(ReportLabels, AFileOfTakesNeedsNoOption) {
  WriteFile(folder_ / "takes.yaml",
            "map: " + docs_ + "/labels.yaml\ntakes:\n  - {recording: " + Path("milk.jsonl") +
                ", labels: " + docs_ + "/labels.csv}\n");
  const Said said = Prehend({"report", Path("takes.yaml"), "-o", Path("page.html")});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(Has(Page(), "<h1>Comparison with labels</h1>"));
}

TEST_F(ReportLabels, GrammarsAndFilesAreComparedWithTheFirst) {
  WriteFile(folder_ / "found/milk.csv",
            "begin_s,end_s,label,hand,object\n1.5,3.8,grasping,right_hand,milk\n");
  const Said said = Report({"--grammar", "pick_and_place_from_motion", "--grammar",
                            "pick_and_place_from_motion", "--grammar", "files:" + Path("found")});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const std::string page = Page();
  EXPECT_TRUE(Has(page, "<h1>Comparison with pick_and_place_from_motion</h1>"));
  EXPECT_TRUE(Has(page, "data-lane=\"2\"")) << "events of the file";
  EXPECT_FALSE(Has(page, "pick_and_place_from_motion: grasping</strong>")) << "itself";
  EXPECT_TRUE(Has(page, ": grasping</strong>")) << "that of the file begins later";
}

TEST_F(ReportLabels, AVideoIsNamedAndNotCopied) {
  const std::string map = ReadFile(docs_ + "/labels.yaml");
  const auto with = [&](const std::string& video) {
    WriteFile(folder_ / "maps/labels.yaml", "offset_s: 0\nvideo: " + video + "\n" + map);
    return Report({"--truth", docs_ + "/labels.csv", "--map", Path("maps/labels.yaml")});
  };
  WriteFile(folder_ / "maps/films of today/milk.mp4", "a video");
  EXPECT_EQ(with("films of today/{take}.mp4").exit_code, 0);
  EXPECT_TRUE(Has(Page(), "<video src=\"maps/films%20of%20today/milk.mp4\" data-offset=\"0\""));
  const Said missing = with("{milk: none.webm}");
  EXPECT_EQ(missing.exit_code, 0);
  EXPECT_TRUE(Has(missing.err, "warning: no video ") && Has(missing.err, "none.webm of milk"))
      << missing.err;
  EXPECT_FALSE(Has(Page(), "<video"));
  const Said wrong = with("milk.avi");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(Has(wrong.err,
                  "labels.yaml:2:8: error: video: expected a file .mp4 or .webm, found "
                  "'milk.avi'"))
      << wrong.err;
}

/// The commands of the page, without repetitions.
std::set<std::string> CommandsOf(const std::string& page) {
  std::set<std::string> commands;
  for (std::size_t at = page.find("prehend explain "); at != std::string::npos;
       at = page.find("prehend explain ", at + 1))
    commands.insert(page.substr(at, page.find_first_of("<\n", at) - at));
  return commands;
}

/// As a shell splits them.
std::vector<std::string> WordsOf(const std::string& command) {
  std::vector<std::string> words(1);
  bool is_quoted = false;
  for (const char c : command) {
    if (c == '\'')
      is_quoted = !is_quoted;
    else if (c == ' ' && !is_quoted)
      words.emplace_back();
    else
      words.back() += c;
  }
  words.erase(words.begin());
  return words;
}

TEST_F(ReportLabels, CommandsAskWhatWasCompared) {
  // Another recording of this name, about something else.
  std::string other = ReadFile(folder_ / "milk.jsonl");
  for (std::size_t at = other.find("milk"); at != std::string::npos; at = other.find("milk"))
    other.replace(at, 4, "soap");
  WriteFile(folder_ / "other/milk.jsonl", other);
  std::size_t asked = 0;
  for (const std::vector<std::string>& sides :
       {std::vector<std::string>{"--truth", docs_ + "/labels.csv", "--map", docs_ + "/labels.yaml",
                                 "--grammar", "pick_and_place_from_motion", "--set",
                                 "lift_rise=30cm"},
        {Path("other/milk.jsonl"), "--grammar", "pick_and_place_from_motion", "--grammar",
         "original_2020"}}) {
    ASSERT_EQ(Report(sides).exit_code, 0);
    for (const std::string& command : CommandsOf(Page())) {
      const bool has_set = sides.back() == "lift_rise=30cm";
      EXPECT_EQ(Has(command, " --set lift_rise=30cm"), has_set) << command;
      EXPECT_TRUE(Has(command, " --grammar ")) << command;
      if (const bool is_question = Has(command, " @"); is_question && ++asked % 4 != 1) continue;
      const Said said = Prehend(WordsOf(command));
      EXPECT_EQ(said.exit_code, 0) << command << said.err;
      const std::size_t at = command.find('@');
      if (at == std::string::npos) continue;
      const std::string time = command.substr(at + 1, command.find('s', at) - at - 1);
      const std::string first = said.out.substr(0, said.out.find('\n'));
      EXPECT_TRUE(Has(first, Has(command, " --expected ") ? " did not happen" : " " + time + ".."))
          << command << first;
    }
  }
  EXPECT_GT(asked, 8u);
  EXPECT_TRUE(Has(Page(), "/other/milk.jsonl --grammar"));
}

TEST_F(ReportLabels, LabelsMayNameSomeRoles) {
  WriteFile(folder_ / "labels.csv", "begin_s,end_s,label\n1.1,3.8,\"grasping(object=milk)\"\n");
  const Said said = Report({"--truth", Path("labels.csv"), "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(nlohmann::json::parse(said.out)["grammars"][0]["total"]["f1_50"], 1.0) << said.out;
  WriteFile(folder_ / "labels.csv",
            "begin_s,end_s,label\n1.1,3.8,\"grasping(object=milk)\"\n,,"
            "\"picking_up(hand=right_hand, object=milk)\"\n");
  const auto events = nlohmann::json::parse(
      Report({"--truth", Path("labels.csv"), "--json"}).out)["grammars"][0]["events"];
  ASSERT_EQ(events.size(), 2u) << "what was looked for and is not there is too much";
  EXPECT_EQ(events[1]["found"], 1);
  WriteFile(folder_ / "labels.csv", "begin_s,end_s,label\n,,grasping\n");
  EXPECT_EQ(Report({"--truth", Path("labels.csv")}).exit_code, 2) << "times are missing";
  WriteFile(folder_ / "labels.csv", "begin_s,end_s,label\n1.1,3.8,\"grasping(thing=milk)\"\n");
  const Said wrong = Report({"--truth", Path("labels.csv")});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(Has(wrong.err, "wanted grasping(hand, object)")) << wrong.err;
}

TEST_F(ReportLabels, AGrammarThatIsAskedForStandsInForAnUnknownOne) {
  const std::vector<std::string> truth = {"--truth", docs_ + "/labels.csv", "--map",
                                          docs_ + "/labels.yaml"};
  WriteFile(folder_ / "milk.jsonl",
            Replaced(ReadFile(folder_ / "milk.jsonl"), R"("grammar":"pick_and_place_from_motion")",
                     R"("grammar":"of_somebody_else")"));
  const Said unknown = Report(truth);
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(Has(unknown.err, "no grammar is called 'of_somebody_else'")) << unknown.err;
  std::vector<std::string> asked = truth;
  asked.insert(asked.end(), {"--grammar", "pick_and_place_from_motion"});
  const Said said = Report(asked);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(Has(said.out, "page.html: 1 take, ")) << said.out;
}

TEST_F(ReportLabels, RefusesWhatIsNotLabelled) {
  EXPECT_EQ(Report({"--map", docs_ + "/labels.yaml"}).exit_code, 2);
  EXPECT_EQ(Report({"--truth", Path("none.csv")}).exit_code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "page.html")) << "nothing is written";
}

}  // namespace
}  // namespace prehend::house

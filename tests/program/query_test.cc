// SPDX-License-Identifier: Apache-2.0
// Questions to recorded episodes, as a person asks them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

/// A carton that is carried, one that is slid, and a drawer whose handle is grasped.
std::string ThreeEpisodes(const std::string& name) {
  const auto file = (FreshFolder(name) / "three.episodes").string();
  for (const char* scenario : {"pick_and_place/milk_carton_wrap", "slide/hop_divides_a_slide",
                               "furniture/drawer_is_opened_with_hook"})
    EXPECT_EQ(Prehend({"run", scenario, "--record", file}).exit_code, 0) << scenario;
  return file;
}

nlohmann::json Asked(const std::string& file, std::vector<std::string> words) {
  words.insert(words.begin(), {"episode", "query", file, "--json"});
  const Said said = Prehend(words);
  EXPECT_TRUE(said.exit_code == 0 || said.exit_code == 4) << said.err;
  return nlohmann::json::parse(said.out);
}

TEST(Query, TheThreeQuestionsOfThePaperAreAnswered) {
  const std::string file = ThreeEpisodes("paper_questions");
  // 1. When was an object of this class slid?
  const auto slid = Asked(file, {"--event", "sliding", "--role", "object=MilkCarton"});
  ASSERT_FALSE(slid.empty());
  for (const auto& answer : slid) {
    EXPECT_EQ(answer["scenario"], "slide/hop_divides_a_slide");
    EXPECT_EQ(answer["roles"]["object"], "milk");
  }
  EXPECT_TRUE(Asked(file, {"--event", "sliding", "--role", "object=Cup"}).empty());
  // 2. When was a handle grasped that is a part of a drawer?
  const auto grasped =
      Asked(file, {"--event", "grasping", "--role", "object=Handle", "--part-of", "object=drawer"});
  ASSERT_EQ(grasped.size(), 1u);
  EXPECT_EQ(grasped[0]["scenario"], "furniture/drawer_is_opened_with_hook");
  EXPECT_TRUE(Asked(file, {"--event", "grasping", "--part-of", "object=table"}).empty());
  // 3. Of what is a pick-and-place composed?
  const auto whole =
      Asked(file, {"--event", "pick_and_place", "--parts", "--episode", "milk_carton_wrap"});
  ASSERT_EQ(whole.size(), 1u);
  std::vector<std::string> parts;
  for (const auto& part : whole[0]["parts"]) parts.push_back(part["event"]);
  for (const char* wanted : {"reaching", "picking_up", "transporting", "putting_down"})
    EXPECT_NE(std::find(parts.begin(), parts.end(), wanted), parts.end()) << wanted;
}

TEST(Query, TimesRelationsAndFormsAreChosen) {
  const std::string file = ThreeEpisodes("query_forms");
  const auto all = Asked(file, {"--event", "transporting"});
  ASSERT_FALSE(all.empty());
  const double begin_s = all[0]["begin_s"], end_s = all[0]["end_s"];
  EXPECT_EQ(Asked(file, {"--event", "transporting", "--lasts-s", "100"}).size(), 0u);
  EXPECT_EQ(Asked(file, {"--event", "transporting", "--lasts-s", "..100"}).size(), all.size());
  EXPECT_EQ(Asked(file, {"--event", "transporting", "--from", std::to_string(begin_s - 0.001),
                         "--to", std::to_string(end_s + 0.001), "--episode", "milk_carton_wrap"})
                .size(),
            1u);
  EXPECT_EQ(Asked(file, {"--event", "picking_up", "--relation", "meets transporting", "--episode",
                         "milk_carton_wrap"})
                .size(),
            1u);
  EXPECT_EQ(Asked(file, {"--event", "picking_up", "--relation", "after transporting", "--episode",
                         "milk_carton_wrap"})
                .size(),
            0u);
  const Said csv = Prehend({"episode", "query", file, "--event", "picking_up", "--csv"});
  EXPECT_TRUE(csv.out.starts_with("file,episode,scenario,event,begin_s,end_s,roles\n")) << csv.out;
  const Said none = Prehend({"episode", "query", file, "--event", "flying"});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_TRUE(none.out.ends_with("0 answers\n")) << none.out;
}

TEST(Query, AnswersAreCountedByColumns) {
  const std::string file = ThreeEpisodes("query_counts");
  const Said said = Prehend(
      {"episode", "query", file, "--event", "grasping", "--count-by", "style,object_class"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.out,
            "style  object_class  count\n"
            "wrap   MilkCarton    2\n"
            "hook   Handle        1\n"
            "3 answers\n");
  const auto json = Asked(file, {"--event", "grasping", "--count-by", "scenario,hand"});
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["hand"], "right_hand");
  EXPECT_EQ(json[0]["count"], 1);
  // The sum is the number of answers, whatever an event lacks.
  const auto all = Asked(file, {});
  for (const char* columns : {"event", "style", "object_class,support", "episode,file"}) {
    std::size_t sum = 0;
    for (const auto& row : Asked(file, {"--count-by", columns}))
      sum += row["count"].get<std::size_t>();
    EXPECT_EQ(sum, all.size()) << columns;
  }
  EXPECT_EQ(
      Prehend({"episode", "query", file, "--event", "contact", "--count-by", "style", "--csv"})
          .out.substr(0, 13),
      "style,count\n,");
  const Said none = Prehend({"episode", "query", file, "--event", "fling", "--count-by", "style"});
  EXPECT_EQ(none.exit_code, 4);
  for (const auto& [columns, why] : std::vector<std::pair<std::string, std::string>>{
           {"stile", "--count-by: there is no column 'stile'; did you mean 'style'? there are: "},
           {"style,object_clas", "did you mean 'object_class'?"},
           {"style,", ""}}) {
    const Said wrong = Prehend({"episode", "query", file, "--count-by", columns});
    EXPECT_EQ(wrong.exit_code, why.empty() ? 0 : 2) << columns;
    EXPECT_NE(wrong.err.find(why), std::string::npos) << wrong.err;
  }
  const Said both = Prehend({"episode", "query", file, "--count-by", "style", "--parts"});
  EXPECT_EQ(both.exit_code, 2);
}

TEST(Query, AWrongQuestionIsExplained) {
  const Said relation = Prehend({"episode", "query", "a.episodes", "--relation", "meet x"});
  EXPECT_EQ(relation.exit_code, 2);
  EXPECT_NE(relation.err.find("did you mean 'meets'?"), std::string::npos) << relation.err;
  const Said role = Prehend({"episode", "query", "a.episodes", "--role", "milk"});
  EXPECT_EQ(role.exit_code, 2);
  EXPECT_NE(role.err.find("found 'milk', wanted ROLE=VALUE"), std::string::npos) << role.err;
  const Said file = Prehend({"episode", "query", "no.episodes"});
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_NE(file.err.find("no such file"), std::string::npos) << file.err;
}

TEST(Query, Sqlite3AnswersTheDocumentedQuestions) {
  if (std::system("command -v sqlite3 >/dev/null") != 0) GTEST_SKIP() << "there is no sqlite3";
  const std::string file = ThreeEpisodes("sqlite_questions");
  const std::string page = ReadFile(PREHEND_SOURCE_DIR "/docs/episodes.md");
  int asked = 0;
  const std::string begin = "\nsqlite3 suite.episodes ";
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const std::size_t question = at + begin.size();
    const std::string text = page.substr(question, page.find('\n', question) - question);
    EXPECT_EQ(std::system(("sqlite3 -bail " + file + " " + text + " >/dev/null").c_str()), 0)
        << text;
    ++asked;
  }
  EXPECT_EQ(asked, 3);
}

TEST(Query, EachAnswerIsDrawn) {
  const std::string file = ThreeEpisodes("query_show");
  const auto folder = FreshFolder("query_shown") / "new";
  const Said bad = Prehend({"episode", "query", file, "--show", file});
  if (bad.err.find("draws no pictures") != std::string::npos) GTEST_SKIP() << bad.err;
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find(file + " is a file of episodes"), std::string::npos) << bad.err;
  const auto answers =
      Asked(file, {"--event", "*ing", "--role", "any=Handle", "--show", folder.string()});
  ASSERT_GT(answers.size(), 1u);
  std::set<std::uintmax_t> sizes;
  for (const auto& answer : answers) {
    const std::string picture = answer["picture"];
    EXPECT_EQ(std::filesystem::path(picture).parent_path(), folder);
    ASSERT_TRUE(std::filesystem::exists(picture)) << picture;
    sizes.insert(std::filesystem::file_size(picture));
  }
  EXPECT_EQ(sizes.size(), answers.size()) << "each shows something else";
  const Said csv = Prehend(
      {"episode", "query", file, "--event", "grasping", "--csv", "--show", folder.string()});
  EXPECT_EQ(csv.out.substr(0, csv.out.find('\n')),
            "file,episode,scenario,event,begin_s,end_s,roles,picture");
}

TEST(Query, AnEventComesWithItsValues) {
  const auto folder = FreshFolder("query_values");
  const std::string file = (folder / "a.episodes").string(),
                    rules = (folder / "own.grammar").string();
  WriteFile(rules,
            "grammar own\nevent near(hand: Hand, object: Movable)\n"
            "  while distance(hand, object) < 20 cm\n  with far = distance(hand, object)@begin\n");
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--grammar", rules, "--record", file}).exit_code,
            0);
  const Said table = Prehend({"episode", "query", file, "--event", "near"});
  EXPECT_NE(table.out.find("object=milk far=0."), std::string::npos) << table.out;
  const auto all = Asked(file, {"--event", "near"});
  ASSERT_FALSE(all.empty());
  EXPECT_GT(all[0]["attributes"]["far"], 0.1);
  EXPECT_LE(all[0]["attributes"]["far"], 0.2);
}

TEST(Query, UnknownNamesAreNamed) {
  const auto file = (FreshFolder("query_names") / "a.episodes").string();
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--record", file}).exit_code, 0);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--role", "hnd=right_hand"}, {"--role", "hnd=Hand"}, {"--part-of", "hnd=table"}}) {
    const Said said = Prehend({"episode", "query", file, words[0], words[1]});
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_EQ(said.err,
              "prehend: " + words[0] + ": no event has a role 'hnd'; did you mean 'hand'?\n");
  }
  const Said typo = Prehend({"episode", "query", file, "--event", "graping"});
  EXPECT_EQ(typo.exit_code, 4);
  EXPECT_EQ(typo.err, "prehend: no event is called 'graping'; did you mean 'grasping'?\n");
  const std::pair<std::string, std::string> values[] = {
      {"object=mlk", "milk"}, {"hand=right_hnd", "right_hand"}, {"object=Movble", "Movable"}};
  for (const auto& [asked, meant] : values) {
    const Said unknown = Prehend({"episode", "query", file, "--role", asked});
    EXPECT_EQ(unknown.exit_code, 4);
    EXPECT_EQ(unknown.err, "prehend: --role: nothing is called '" +
                               asked.substr(asked.find('=') + 1) + "', or is one; did you mean '" +
                               meant + "'?\n");
  }
  const Said far = Prehend({"episode", "query", file, "--event", "xyzzy", "--role", "any=ArmPart"});
  EXPECT_EQ(far.exit_code, 4);
  EXPECT_EQ(far.err,
            "prehend: no event is called 'xyzzy'\nprehend: --role: nothing is called 'ArmPart', or "
            "is one\n");
  EXPECT_EQ(Prehend({"episode", "query", file, "--event", "grasp*", "--role", "any=cup*"}).err, "");
}

}  // namespace
}  // namespace prehend::house

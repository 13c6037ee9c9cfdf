// SPDX-License-Identifier: Apache-2.0
// `prehend grammar coverage`, by recordings whose coverage is known on paper.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

using Json = nlohmann::json;

constexpr const char* kGrammar = R"(grammar shelf
param low = 10 cm
event shelved(a: Movable)
  while height(a) > low and not height(a) > 1 m
  bridging 50 ms
  lasting 0.2 s
)";

/// A cup that is at these heights, a tenth of a second each, as a recording.
std::string CupAt(const std::vector<double>& heights_m) {
  std::string lines =
      R"({"recording": 1, "episode": "cup", "grammar": "shelf", "ticks_per_second": 1000, "bridge_s": 0,)"
      R"( "entities": {"cup": {"class": "Cup", "size_m": [0.1, 0.1, 0.1]}}})"
      "\n";
  int tick = 0;
  for (const double height_m : heights_m) {
    lines +=
        Json{{"tick", tick}, {"samples", {{"cup", {{"at_m", {0, 0, height_m}}}}}}}.dump() + "\n";
    tick += 100;
  }
  return lines + Json{{"end_tick", tick}}.dump() + "\n";
}

class GrammarCoverage : public testing::Test {
 protected:
  void SetUp() override {
    folder = FreshFolder("coverage");
    WriteFile(folder / "shelf.grammar", kGrammar);
  }
  std::string Kept(const std::string& name, const std::vector<double>& heights_m) const {
    WriteFile(folder / name, CupAt(heights_m));
    return (folder / name).string();
  }
  Said Covered(std::vector<std::string> words) const {
    words.insert(words.begin(), {"grammar", "coverage"});
    words.insert(words.end(), {"--grammar", (folder / "shelf.grammar").string()});
    return Prehend(words);
  }
  static const Json& ClauseOf(const Json& coverage, const std::string& part,
                              const std::string& text) {
    for (const Json& clause : coverage["clauses"])
      if (clause["part"] == part && clause["text"].get<std::string>().starts_with(text))
        return clause;
    ADD_FAILURE() << part << " " << text << " is no clause";
    return coverage;
  }

  std::filesystem::path folder;
};

// Up for 0.1 s, thrice with gaps of 0.1 s, and twice: 'at least 3' decides both ways.
TEST_F(GrammarCoverage, OfASeriesHasItsGapAndItsNumber) {
  WriteFile(folder / "shelf.grammar",
            "grammar shelf\nevent raised(a: Movable) while height(a) > 10 cm\n"
            "event knocking(a: Movable) repeat raised(a) at least 3, gap at most 0.15 s\n");
  const std::string file = Kept("a.jsonl", {0, 1, 0, 1, 0, 1, 0, 0, 0, 1, 0, 1, 0});
  const Json coverage = Json::parse(Covered({file, "--json"}).out);
  EXPECT_EQ(ClauseOf(coverage, "at least", "3")["all"]["decided"], (Json{1, 1}));
  EXPECT_EQ(ClauseOf(coverage, "gap at most", "150 ms")["all"]["decided"], (Json{1, 3}));
  EXPECT_EQ(coverage["clauses"].size(), 3U) << coverage["clauses"];
}

TEST_F(GrammarCoverage, SaysWhichClausesDecidedAndHowNear) {
  const std::string file = Kept("a.jsonl", {0.04, 0.5, 0.5, 0.5, 0.07, 0.5, 0.07});
  const Said said = Covered({file, "--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const Json coverage = Json::parse(said.out);
  const Json& rule = coverage["rules"][0];
  EXPECT_EQ(rule["name"], "shelved");
  EXPECT_EQ(rule["bound"], 1);
  EXPECT_EQ(rule["begun"], 2);
  EXPECT_EQ(rule["became"], (Json{{"interval", 1}, {"too short", 1}}));

  const Json& low = ClauseOf(coverage, "while", "height(a) > low");
  EXPECT_EQ(low["line"], 4);
  EXPECT_EQ(low["column"], 19);
  EXPECT_EQ(low["all"]["decided"], (Json{3, 4}));
  EXPECT_NEAR(low["all"]["nearest"][0].get<double>(), 0.03, 1e-9);
  EXPECT_NEAR(low["all"]["nearest"][1].get<double>(), 0.4, 1e-9);
  EXPECT_EQ(low["unit"], "m");
  EXPECT_EQ(low["began"], 2);
  EXPECT_EQ(low["ended"], 2);
  // Where the cup is low, it does not matter that it is not high either.
  const Json& high = ClauseOf(coverage, "while", "height(a) > 1 m");
  EXPECT_EQ(high["all"]["decided"], (Json{4, 0}));
  EXPECT_EQ(high["all"]["nearest"][1], nullptr);

  const Json& bridging = ClauseOf(coverage, "bridging", "50 ms");
  EXPECT_EQ(bridging["all"]["decided"], (Json{1, 0}));
  EXPECT_NEAR(bridging["all"]["nearest"][0].get<double>(), 0.05, 1e-9);
  const Json& lasting = ClauseOf(coverage, "lasting", "200 ms");
  EXPECT_EQ(lasting["all"]["decided"], (Json{1, 1}));
  EXPECT_NEAR(lasting["all"]["nearest"][0].get<double>(), 0.1, 1e-9);
  EXPECT_EQ(coverage["shares"]["clauses"], (Json{{"covered", 2}, {"all", 4}}));
}

// As the engine does: in the first frame after the interval, and not of what was too short.
TEST_F(GrammarCoverage, AsksForWhatIsRequiredWhereTheEngineDoes) {
  WriteFile(folder / "shelf.grammar",
            "grammar shelf\nevent shelved(a: Movable)\n  while height(a) > 10 cm\n  lasting 0.2 s\n"
            "  requires height(a) < 6 cm\n");
  const Json coverage = Json::parse(
      Covered({Kept("a.jsonl", {0.5, 0.5, 0.04, 0.5, 0.5, 0.07, 0.5, 0.04}), "--json"}).out);
  EXPECT_EQ(coverage["rules"][0]["became"],
            (Json{{"interval", 1}, {"refused", 1}, {"too short", 1}}));
  EXPECT_EQ(ClauseOf(coverage, "requires", "height(a) < ")["all"]["decided"], (Json{1, 1}));
}

// `one .. per` takes a rule apart; its clauses are those that stand in the file.
TEST_F(GrammarCoverage, HasTheClausesOfOnePer) {
  WriteFile(folder / "shelf.grammar",
            "grammar shelf\nevent beside(a: Movable, b: Entity)\n  while height(a) > 10 cm\n"
            "  until height(a) < 5 cm\n  one a per b\n");
  const Json coverage =
      Json::parse(Covered({Kept("a.jsonl", {0.07, 0.5, 0.07, 0.5, 0.04}), "--json"}).out);
  ASSERT_EQ(coverage["rules"].size(), 1u);
  EXPECT_EQ(ClauseOf(coverage, "while", "height(a) > ")["is_threshold"], true);
  EXPECT_EQ(ClauseOf(coverage, "until", "height(a) < ")["is_threshold"], true);
}

TEST_F(GrammarCoverage, NamesASmallestSetAndFailsBelowAShare) {
  const std::string dull = Kept("dull.jsonl", {0.04, 0.5, 0.5, 0.5, 0.07}),
                    same = Kept("same.jsonl", {0.04, 0.5, 0.5, 0.5, 0.07, 0.5, 0.07}),
                    high = Kept("high.jsonl", {0.5, 0.5, 0.5, 1.5, 0.5, 0.5, 0.5});
  const Json coverage = Json::parse(Covered({dull, same, high, "--json"}).out);
  EXPECT_EQ(coverage["smallest"], (Json{1, 2}));
  const Said enough = Covered({dull, same, high, "--within", "25"});
  EXPECT_EQ(enough.exit_code, 0) << enough.err;
  EXPECT_NE(enough.out.find("2 of 3 episodes show as much as all"), std::string::npos)
      << enough.out;
  const Said short_of_it = Covered({dull, "--within", "25"});
  EXPECT_EQ(short_of_it.exit_code, 1);
  EXPECT_NE(short_of_it.err.find("25.0 % of the clauses decided both ways, wanted 75 %"),
            std::string::npos)
      << short_of_it.err;
}

TEST_F(GrammarCoverage, WritesLcovAndRefusesOtherFiles) {
  const std::string file = Kept("a.jsonl", {0.04, 0.5, 0.5, 0.5, 0.07}),
                    info = (folder / "coverage.info").string();
  ASSERT_EQ(Covered({file, "-o", info}).exit_code, 0);
  const std::string lcov = ReadFile(info);
  EXPECT_EQ(lcov.substr(0, 7), "TN:\nSF:");
  for (const char* line :
       {"FNDA:1,shelved\n", "BRDA:4,2,0,2\n", "BRDA:4,2,1,3\n", "DA:4,8\n", "LH:2\n"})
    EXPECT_NE(lcov.find(line), std::string::npos) << line << lcov;
  EXPECT_EQ(Covered({file, "-o", (folder / "coverage.txt").string()}).exit_code, 2);
  EXPECT_EQ(Covered({"none.jsonl"}).exit_code, 2);
}

// It is a look at the engine's own record: its intervals are the events.
TEST_F(GrammarCoverage, CountsTheEventsThatAreThereWithoutIt) {
  const auto file = (folder / "milk.episodes").string();
  ASSERT_EQ(Prehend({"run", "pick_and_place/milk_carton_wrap", "--record", file}).exit_code, 0);
  const auto events = [&] {
    std::map<std::string, int> counts;
    const Json said = Json::parse(
        Prehend({"episode", "resegment", file, "--grammar", "pick_and_place", "--json"}).out);
    for (const Json& event : said["events"]) ++counts[event["event"]];
    return counts;
  };
  auto before = events();
  const Json coverage = Json::parse(
      Prehend({"grammar", "coverage", file, "--grammar", "pick_and_place", "--json"}).out);
  EXPECT_EQ(events(), before);
  for (const Json& rule : coverage["rules"]) {
    if (rule["is_event"].get<bool>()) {
      EXPECT_EQ(rule["became"].value("interval", 0), before[rule["name"]]) << rule["name"];
    }
  }
  EXPECT_GE(before.size(), 8u);
}

}  // namespace
}  // namespace prehend::house

// SPDX-License-Identifier: Apache-2.0
// Files of labels against each other: how two people agree.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

class Agreement : public testing::Test {
 protected:
  std::string File(const std::string& name, const std::string& rows) const {
    WriteFile(folder_ / name, "begin_s,end_s,label,tier\n" + rows);
    return (folder_ / name).string();
  }
  static std::string Rows(double later_s) {
    std::ostringstream rows;
    for (const auto& [begin, end, label] : {std::tuple{0.5, 1.2, "reach"},
                                            {1.2, 3.0, "hold"},
                                            {3.4, 4.1, "reach"},
                                            {4.1, 6.25, "hold"}})
      rows << begin + later_s << "," << end + later_s << "," << label << ",right\n";
    return rows.str();
  }
  static nlohmann::json Json(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Said said = Prehend(words);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.exit_code == 0 ? nlohmann::json::parse(said.out)["grammars"][0] : nlohmann::json();
  }
  const std::filesystem::path folder_ = FreshFolder("agreement");
};

TEST_F(Agreement, ACopyThatIsMovedIsOffByAsMuch) {
  const std::string anna = File("anna.csv", Rows(0));
  const auto same = Json({"score", anna, "--truth", anna});
  EXPECT_EQ(same["total"]["kappa"], 1);
  EXPECT_EQ(same["total"]["f1_50"], 1);
  for (const double moved_s : {0.1, -0.037, 0.25}) {
    const std::string ben = File("ben.csv", Rows(moved_s));
    const auto json = Json({"score", ben, "--truth", anna});
    for (const char* end : {"begin_s", "end_s"})
      for (const char* figure : {"median", "p95", "max"})
        EXPECT_NEAR(json["total"][end][figure], moved_s, 1e-9) << end << figure;
    EXPECT_LT(json["total"]["kappa"], 1);
    EXPECT_GT(json["total"]["kappa"], 0.5);
  }
}

TEST_F(Agreement, CollarsOfEachEventAreMeasured) {
  // Reaches are 100 ms apart at most, holds 240 ms.
  const std::string anna = File("anna.csv", Rows(0)),
                    ben = File("ben.csv",
                               "0.5,1.3,reach,right\n1.24,3.0,hold,right\n3.5,4.05,reach,right\n"
                               "4.1,6.01,hold,right\n");
  const Said text = Prehend({"score", ben, "--truth", anna});
  const std::string line = "in a map: collar_ms: {hold: 240, reach: 100}  # 95 % of the boundaries";
  EXPECT_NE(text.out.find(line), std::string::npos) << text.out;
}

TEST_F(Agreement, CollarsOfEventsArePooledAndTheLineIsForAMap) {
  // As `resegment -o` writes them; and labels whose names need quotes.
  const auto rows = [&](const char* name, double later_s, const std::string& one,
                        const std::string& other) {
    return File(
        name, std::to_string(0.5 + later_s) + ",1.2," + one + ",right\n3,4," + other + ",right\n");
  };
  const std::string held = "\"grasping(right_hand, cup)\"", also = "\"grasping(left_hand, pot)\"",
                    map = (folder_ / "map.yaml").string();
  for (const auto& [one, other, line, labels] :
       {std::tuple{held, also, "collar_ms: {grasping: 200}", "labels: {hold: {event: grasping}}"},
        {std::string("\"pick up, then\""), std::string("hold"),
         R"(collar_ms: {"pick up, then": 200, hold: 1})",
         R"(labels: {hold: {event: grasping}, "pick up, then": {event: picking_up}})"}}) {
    const std::string anna = rows("anna.csv", 0, one, other),
                      ben = rows("ben.csv", 0.2, one, other);
    const Said said = Prehend({"score", ben, "--truth", anna});
    ASSERT_NE(said.out.find(std::string("in a map: ") + line), std::string::npos) << said.out;
    WriteFile(map, std::string(labels) + "\n" + line + "\n");
    WriteFile(folder_ / "hold.csv", "begin_s,end_s,label\n1,2,hold\n");
    const std::string hold = (folder_ / "hold.csv").string();
    const Said pasted =
        Prehend({"score", hold, "--truth", hold, "--map", map, "--grammar", "pick_and_place"});
    EXPECT_EQ(pasted.exit_code, 0) << pasted.err;
  }
}

TEST_F(Agreement, KappaIsOfFrames) {
  // Of 10 s 4 s are marked by both, 1 s by each alone: 0.8 agree, 0.5 by chance.
  const std::string anna = File("a.csv", "0,5,hold,right\n9.9,10,rest,right\n"),
                    ben = File("b.csv", "1,6,hold,right\n9.9,10,rest,right\n");
  const auto json = Json({"score", ben, "--truth", anna});
  for (const auto& event : json["events"]) {
    if (event["event"] == "rest") continue;
    EXPECT_NEAR(event["kappa"], 0.6, 1e-9);
  }
  const Said text = Prehend({"score", ben, "--truth", anna});
  EXPECT_NE(text.out.find("kappa of frames: hold 0.60, rest 1.00, all "), std::string::npos)
      << text.out;
  // Nobody says that there was nothing before 0.
  const auto early = Json({"score", File("e.csv", "-2,3,hold,right\n6.9,7,rest,right\n"), "--truth",
                           File("f.csv", "-3,2,hold,right\n6.9,7,rest,right\n")});
  for (const auto& event : early["events"]) {
    if (event["event"] == "rest") continue;
    EXPECT_NEAR(event["kappa"], 0.6, 1e-9) << event;
  }
  const Said hardly = Prehend({"score", File("c.csv", "5,6,hold,right\n6,6.01,rest,right\n"),
                               "--truth", File("d.csv", "0,0.01,hold,right\n6,6.01,rest,right\n")});
  EXPECT_NE(hardly.out.find("kappa of frames: hold 0.00, rest 1.00"), std::string::npos)
      << hardly.out;
}

TEST_F(Agreement, OtherFormatsAndAMapDo) {
  const std::string anna = File("anna.csv", Rows(0)), map = (folder_ / "map.yaml").string();
  WriteFile(map,
            "tiers: {right: {hand: right_hand}}\nlabels:\n  reach: {event: reaching}\n  hold: "
            "{event: grasping}\n");
  WriteFile(folder_ / "ben.txt", "reach\nreach\nhold\nhold\n");
  WriteFile(folder_ / "ben.tsv", "onset\tduration\tlabel\ttier\n0.5\t0.7\treach\tright\n");
  const auto json = Json({"score", (folder_ / "ben.tsv").string(), "--truth", anna, "--map", map,
                          "--grammar", "pick_and_place"});
  EXPECT_EQ(json["total"]["true"], 4);
  EXPECT_EQ(json["total"]["found"], 1);
  EXPECT_EQ(json["events"][0]["event"], "grasping");
  const Said no_grammar = Prehend({"score", anna, "--truth", anna, "--map", map});
  EXPECT_EQ(no_grammar.exit_code, 2);
  EXPECT_NE(no_grammar.err.find("hint: --grammar NAME, for the map"), std::string::npos);
  const Said uneven = Prehend({"score", anna, anna, "--truth", anna});
  EXPECT_EQ(uneven.exit_code, 2);
}

TEST_F(Agreement, TwoPeopleInOneFileAreNotTakenForOne) {
  const std::string twice = File("twice.csv", Rows(0) + Rows(0.1));
  const Said warned = Prehend({"score", twice, "--truth", twice});
  EXPECT_NE(warned.err.find("4 labels overlap another one of the same event and roles, and are one "
                            "with it"),
            std::string::npos)
      << warned.err;
  WriteFile(folder_ / "both.csv", "coder,begin_s,end_s,label\nanna,0,1,hold\nben,0.1,1.1,hold\n");
  const std::string both = (folder_ / "both.csv").string();
  const Said refused = Prehend({"score", both, "--truth", both});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("the column 'coder' has several values"), std::string::npos)
      << refused.err;
  WriteFile(both, "video,coder,begin_s,end_s,label\nP1,anna,0,1,hold\nP2,ben,0.1,1.1,hold\n");
  const Said two = Prehend({"score", both, "--truth", both});
  EXPECT_NE(two.err.find("the columns 'video' and 'coder' have several values, and nothing says"),
            std::string::npos)
      << two.err;
}

}  // namespace
}  // namespace prehend::house

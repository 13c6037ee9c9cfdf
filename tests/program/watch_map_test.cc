// SPDX-License-Identifier: Apache-2.0
// Lines of a table of poses while they come, by the map of an import: the events are those of the
// file imported at once. What holds now, before it is certain.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/program/import_csv.h"
#include "tests/program/layout_files.h"

namespace prehend::house {
namespace {

using Json = nlohmann::json;

std::vector<Json> Lines(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  return lines;
}

const std::string kEntities =
    "entities:\n  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}\n"
    "  cup: {from: Cup, class: Cup, size_m: [0.08, 0.08, 0.1]}\n"
    "  hand: {from: Hand, hand: true, size_m: [0, 0, 0]}\n";

struct Watched {
  Said said;
  std::filesystem::path folder;
};

Watched Watch(const std::string& bytes, const std::string& map,
              const std::vector<std::string>& more = {"--json"},
              const std::string& file = "poses.csv") {
  Watched watched{.said = {}, .folder = FreshFolder("watch_map")};
  WriteFile(watched.folder / file, bytes);
  WriteFile(watched.folder / "map.yaml", "import: 1\n" + map);
  std::vector<std::string> words = {"grammar", "watch", (watched.folder / file).string(), "--map",
                                    (watched.folder / "map.yaml").string()};
  words.insert(words.end(), more.begin(), more.end());
  watched.said = Prehend(words);
  return watched;
}

/// Event and roles of each, with begin and end in ticks.
std::multiset<std::string> Events(const std::vector<Json>& events) {
  std::multiset<std::string> all;
  for (const Json& event : events)
    all.insert(event["event"].get<std::string>() + event["roles"].dump() + " " +
               event["begin_tick"].dump() + " " + event["end_tick"].dump());
  return all;
}

void ExpectTheEventsOfImport(const std::string& bytes, const std::string& map,
                             const std::string& file = "poses.csv",
                             const std::vector<std::string>& grammar = {}) {
  std::vector<std::string> more = {"--json"};
  more.insert(more.end(), grammar.begin(), grammar.end());
  const Watched watched = Watch(bytes, map, more, file);
  EXPECT_EQ(watched.said.exit_code, 0) << watched.said.err;
  EXPECT_EQ(watched.said.err, "");
  const std::string take = (watched.folder / "take.jsonl").string();
  const Said import = Prehend({"import", (watched.folder / file).string(), "--map",
                               (watched.folder / "map.yaml").string(), "-o", take});
  ASSERT_EQ(import.exit_code, 0) << import.err;
  more.insert(more.begin(), {"episode", "resegment", take});
  const Json all = Json::parse(Prehend(more).out)["events"];
  EXPECT_GT(all.size(), 8u);
  EXPECT_EQ(Events(Lines(watched.said.out)), Events({all.begin(), all.end()}));
}

const std::string kMap =
    "unit: m\naxes: z_up\ntime_unit: s\ncolumns: {time: t, position: [\"{}_x\", \"{}_y\", "
    "\"{}_z\"]}\n" +
    kEntities;

std::string Row(int i, double ahead_s = 0) {
  return Text(i / kRate_hz + ahead_s) + "," + Three(CupAt(i / kRate_hz), 1, ",") + "," +
         Three(HandAt(i / kRate_hz), 1, ",");
}

std::string Csv(const std::function<std::string(int)>& row) {
  return "t,Cup_x,Cup_y,Cup_z,Hand_x,Hand_y,Hand_z\n" + Rows(row);
}

TEST(WatchMap, GivesTheEventsOfTheSameTableImported) {
  ExpectTheEventsOfImport(Csv([](int i) { return Row(i); }), kMap);
  ExpectTheEventsOfImport(MotiveCsv({}), "axes: y_up\n" + kEntities);
  ExpectTheEventsOfImport(
      MotiveCsv({.unit = "Millimeters", .rotation = "XYZ", .scale = 1000, .end = "\r\n"}),
      "axes: y_up\n" + Replaced(kEntities, "0.1]}\n  hand", "0.1], upright_at_s: 0}\n  hand"));
  std::string rows = "frame,name,x,y,z\n";
  for (int i = 0; i < kFrames; ++i)
    for (const char* body : {"Cup", "Hand"})
      rows += std::to_string(i) + "," + body + "," +
              Three(body[0] == 'C' ? CupAt(i / kRate_hz) : HandAt(i / kRate_hz), 1, ",") + "\n";
  ExpectTheEventsOfImport(
      rows,
      "unit: m\naxes: z_up\ntime_unit: frame\nrate_hz: 60\ncolumns: {time: frame, body: name, "
      "position: [x, 'y', z]}\n" +
          kEntities);
}

TEST(WatchMap, TablesOfTrackersAreKnownByTheirHeads) {
  // As Motive writes them, with numbers for identifiers, and a first row in which nothing is seen.
  std::string motive = MotiveCsv({});
  for (std::size_t at; (at = motive.find("\"A1\"")) != std::string::npos;)
    motive.replace(at, 4, "1");
  ExpectTheEventsOfImport(motive, "axes: y_up\n" + kEntities);
  const Watched late = Watch(MotiveCsv({.labels = true, .lost_from = 0, .lost_until = 3}),
                             "axes: y_up\nlost: unknown\n" + kEntities);
  EXPECT_EQ(late.said.exit_code, 0);
  EXPECT_EQ(late.said.err,
            "warning: 'hand' is not tracked in 1 gap: 0.000 s are bridged, in 0.050 s it is "
            "unknown\n");
  const std::string vicon =
      "axes: z_up\n" + Replaced(Replaced(kEntities, "from: Cup", "from: \"s:Cup\""), "from: Hand",
                                "from: \"s:Hand\"");
  // Of Vicon's parts one is read, here as in a file.
  ExpectTheEventsOfImport(
      "Devices\n1000\n,,Plate,,\nFrame,Sub Frame,Fx,Fy,Fz\n,,N,N,N\n1,0,1,2,3\n1,1,1,2,3\n\n" +
          ViconCsv("Objects", "Quaternion") +
          "\nTrajectories\n60\n,,M,,\nFrame,,X,Y,Z\n1,0,1,2,3\n",
      vicon);
  ExpectTheEventsOfImport(QualisysTsv({}), "axes: z_up\n" + kEntities, "take.tsv");
  ExpectTheEventsOfImport(Trc("Cup\t\t\tHand\t\t", "mm", 1000, "\n"), "axes: y_up\n" + kEntities,
                          "take.trc");
}

const std::string kJoints =
    "  drawer: {at_m: [0.6, 0.3, 0.4], class: Drawer, size_m: [0.4, 0.4, 0.15], joint: {from: v, "
    "closed: 0, open: 0.4}}\n";

double OpenAt(int i) { return std::clamp((i - 100) / 200.0, 0.0, 0.4); }

/// The rows of a time in this order: c the cup, h the hand, l a lamp that the map does not mention,
/// d how far the drawer is open.
std::string InOrder(const std::string& order, const std::string& more = {}) {
  std::string rows = "name,t,x,y,z,v\n";
  for (int i = 0; i < kFrames; ++i) {
    const std::string t = Text(i / kRate_hz);
    for (const char of : order)
      rows += of == 'c'   ? "Cup," + t + "," + Three(CupAt(i / kRate_hz), 1, ",") + ",\n"
              : of == 'h' ? "Hand," + t + "," + Three(HandAt(i / kRate_hz), 1, ",") + ",\n"
              : of == 'l' ? "Lamp," + t + ",1,1,1,\n"
                          : "drawer," + t + ",,,," + Text(OpenAt(i)) + "\n";
    if (i == 60) rows += more;
  }
  return rows;
}

const std::string kRowsMap =
    "unit: m\naxes: z_up\ntime_unit: s\ncolumns: {body: name, time: t, position: [x, 'y', z]}\n" +
    kEntities;

TEST(WatchMap, WhateverStandsLastInAFrameIsOfThatFrame) {
  const auto folder = FreshFolder("watch_grammar");
  WriteFile(folder / "both.grammar", "grammar both\nuse pick_and_place_from_motion\nuse joints\n");
  const std::vector<std::string> both = {"--grammar", (folder / "both.grammar").string()};
  for (const char* order : {"chl", "lch", "clh"}) ExpectTheEventsOfImport(InOrder(order), kRowsMap);
  for (const char* order : {"chd", "dch", "cdh", "chld", "chdl"})
    ExpectTheEventsOfImport(InOrder(order), kRowsMap + kJoints, "poses.csv", both);
  const Watched joint =
      Watch(InOrder("chd"), kRowsMap + kJoints, {"--json", "--grammar", both.back()});
  EXPECT_NE(joint.said.out.find("opening"), std::string::npos) << joint.said.out;
  // The same as lines of JSON.
  std::string lines, map = Replaced(Replaced(kRowsMap, "from: Cup", "position: \"[n=Cup].p\""),
                                    "from: Hand", "position: \"[n=Hand].p\"");
  map = "t: t\n" + map.erase(map.find("columns"), map.find("entities") - map.find("columns"));
  for (int i = 0; i < kFrames; ++i) {
    const std::string t = ", \"t\": " + Text(i / kRate_hz);
    lines += "{\"n\": \"Cup\"" + t + ", \"p\": [" + Three(CupAt(i / kRate_hz), 1, ", ") + "]}\n" +
             "{\"n\": \"Hand\"" + t + ", \"p\": [" + Three(HandAt(i / kRate_hz), 1, ", ") +
             "]}\n{\"n\": \"drawer\"" + t + ", \"v\": " + Text(OpenAt(i)) + "}\n{\"n\": \"Lamp\"" +
             t + ", \"p\": [1, 1, 1]}\n";
  }
  ExpectTheEventsOfImport(lines, map, "rows.jsonl");
  ExpectTheEventsOfImport(lines, map + Replaced(kJoints, "from: v", "from: \"[n=drawer].v\""),
                          "rows.jsonl", both);
  // Each line with a member of its own.
  std::string members;
  for (int i = 0; i < kFrames; ++i)
    members += "{\"t\": " + Text(i / kRate_hz) + ", \"cup\": [" +
               Three(CupAt(i / kRate_hz), 1, ", ") + "]}\n{\"t\": " + Text(i / kRate_hz) +
               ", \"hand\": [" + Three(HandAt(i / kRate_hz), 1, ", ") + "]}\n";
  ExpectTheEventsOfImport(members,
                          Replaced(Replaced(map, "\"[n=Cup].p\"", "cup"), "\"[n=Hand].p\"", "hand"),
                          "rows.jsonl");
  // What comes twice is as wrong as in a file.
  for (const auto& [more, why] :
       {std::pair<std::string, std::string>("Cup,1.000000,9,9,9,\n", "'Cup' has two poses at 1 s"),
        {"drawer,1.000000,,,,0.3\n", "'v' has two values at 1 s"},
        {"Cup,0.900000,9,9,9,\n", "times must increase: 0.9 s comes after 1 s"}}) {
    const Watched twice =
        Watch(InOrder("chd", more), kRowsMap + kJoints, {"--json", "--grammar", both.back()});
    EXPECT_EQ(twice.said.exit_code, 2);
    EXPECT_NE(twice.said.err.find(why), std::string::npos) << twice.said.err;
    EXPECT_NE(twice.said.err.find("1 faulty line was skipped"), std::string::npos)
        << twice.said.err;
    EXPECT_EQ(twice.said.out, joint.said.out);
  }
}

// A pause in which no row comes, while the cup stands and while it is carried.
TEST(WatchMap, WhatNoRowTellsIsLostAsInAnImport) {
  for (const auto& [from, until] : {std::pair(20, 60), {150, 190}}) {
    std::string csv = Csv([](int i) { return Row(i); });
    std::istringstream lines(csv);
    csv = "";
    int i = -1;
    for (std::string line; std::getline(lines, line); ++i)
      if (i < from || i >= until) csv += line + "\n";
    for (const char* lost : {"unknown", "hold", "in_rows"}) {
      const std::string map = std::string("lost: ") + lost + "\n" + kMap;
      const Watched watched = Watch(csv, map);
      EXPECT_EQ(watched.said.exit_code, 0) << watched.said.err;
      const std::string take = (watched.folder / "take.jsonl").string();
      ImportCsv(watched.folder, csv, "import: 1\n" + map);
      const Json all = Json::parse(Prehend({"episode", "resegment", take, "--json"}).out)["events"];
      EXPECT_EQ(Events(Lines(watched.said.out)), Events({all.begin(), all.end()}))
          << lost << " from " << from;
    }
  }
}

/// A frame as Leap and Quest log it.
std::string JsonFrame(int i, bool has_hand = true) {
  const auto cup = CupAt(i / kRate_hz), hand = HandAt(i / kRate_hz);
  const std::string palm = "{\"type\": \"right\", \"palm\": [" + Three(hand, 1, ", ") + "]}";
  return "{\"t\": " + Text(1000 * i / kRate_hz) + ", \"hands\": [" + (has_hand ? palm : "") +
         "], \"objects\": [{\"name\": \"Cup\", \"pos\": {\"x\": " + Text(cup.x) +
         ", \"y\": " + Text(cup.y) + ", \"z\": " + Text(cup.z) + "}}]}";
}

const std::string kJsonMap =
    "unit: m\naxes: z_up\nt: t\ntime_unit: ms\n" +
    Replaced(Replaced(kEntities, "from: Cup", "position: \"objects[name=Cup].pos\""), "from: Hand",
             "position: \"hands[type=right].palm\"");

TEST(WatchMap, LinesOfJsonAreReadByThePathsOfTheMap) {
  const std::string all = Rows([](int i) { return JsonFrame(i); });
  ExpectTheEventsOfImport(all, kJsonMap, "take.ndjson");
  ExpectTheEventsOfImport(all, Replaced(kJsonMap, "t: t\ntime_unit: ms", "rate_hz: 60"),
                          "take.json");
  std::string rows;  // one body a line
  for (int i = 0; i < kFrames; ++i)
    for (const char* body : {"Cup", "Hand"}) {
      const auto at = body[0] == 'C' ? CupAt(i / kRate_hz) : HandAt(i / kRate_hz);
      rows += std::string("{\"n\": \"") + body + "\", \"t\": " + Text(1000 * i / kRate_hz) +
              ", \"p\": [" + Three(at, 1, ", ") + "]}\n";
    }
  std::string by_rows = kJsonMap;
  for (const auto& [was, is] :
       {std::pair("objects[name=Cup].pos", "[n=Cup].p"), {"hands[type=right].palm", "[n=Hand].p"}})
    by_rows = Replaced(by_rows, was, is);
  ExpectTheEventsOfImport(rows, by_rows, "rows.jsonl");
  // What has no time is left out, and is told, as `import` does.
  const Watched untimed =
      Watch(Rows([](int i) {
              return i % 100 == 0 ? Replaced(JsonFrame(i), "\"t\"", "\"u\"") : JsonFrame(i);
            }),
            kJsonMap, {"--json"}, "take.ndjson");
  EXPECT_EQ(untimed.said.exit_code, 0) << untimed.said.err;
  EXPECT_NE(untimed.said.err.find("take.ndjson:1:1: warning: it has no time, or nothing that the "
                                  "map asks for, and is left out"),
            std::string::npos)
      << untimed.said.err;
  EXPECT_NE(untimed.said.err.find("lines in all, the first: it has no time"), std::string::npos)
      << untimed.said.err;
  EXPECT_NE(untimed.said.out.find("grasping"), std::string::npos);
  // What is lost for a while, and lines that are none.
  const Watched lost =
      Watch(Rows([](int i) { return i == 50 || i == 60 ? "{\"t\": 3" : JsonFrame(i, i < 250); }),
            kJsonMap + "lost: unknown\n", {"--json"}, "take.ndjson");
  EXPECT_EQ(lost.said.exit_code, 2);
  EXPECT_NE(lost.said.err.find("take.ndjson:51:"), std::string::npos) << lost.said.err;
  EXPECT_NE(lost.said.err.find("2 lines in all"), std::string::npos) << lost.said.err;
  EXPECT_NE(lost.said.out.find("grasping"), std::string::npos);
  const Watched own =
      Watch("{\"recording\": 1, \"episode\": \"x\"}\n", kJsonMap, {"--json"}, "take.ndjson");
  EXPECT_EQ(own.said.exit_code, 2);
  EXPECT_NE(own.said.err.find("these are lines of a recording"), std::string::npos) << own.said.err;
  EXPECT_EQ(Watch(all, Replaced(kJsonMap, "ms", "fortnights"), {}, "take.ndjson").said.exit_code,
            2);
}

TEST(WatchMap, FaultyRowsAreNamedOnceOfAKindAndLeftOut) {
  const std::string all = Watch(Csv([](int i) { return Row(i); }), kMap).said.out;
  const Watched watched = Watch(Csv([](int i) {
                                  if (i == 60) return Row(i) + "\n" + Row(i, 9'000'000);
                                  return i > 100 && i < 105 ? Row(i) + "\n1.5,,oh,2,3,4,5" : Row(i);
                                }),
                                kMap);
  EXPECT_EQ(watched.said.exit_code, 2);
  EXPECT_EQ(watched.said.out, all) << watched.said.err;
  EXPECT_NE(watched.said.err.find("poses.csv:63:"), std::string::npos) << watched.said.err;
  EXPECT_NE(watched.said.err.find("s after the one before is left out"), std::string::npos)
      << watched.said.err;
  EXPECT_NE(watched.said.err.find("poses.csv:105:"), std::string::npos) << watched.said.err;
  EXPECT_EQ(watched.said.err.find("poses.csv:107:"), std::string::npos) << watched.said.err;
  EXPECT_NE(watched.said.err.find("4 lines in all"), std::string::npos) << watched.said.err;
  EXPECT_NE(watched.said.err.find("5 faulty lines were skipped"), std::string::npos)
      << watched.said.err;
}

TEST(WatchMap, TimesThatGoBackAreToldInSeconds) {
  const Watched watched = Watch(Csv([](int i) { return Row(i < 200 ? i : i - 100); }), kMap);
  EXPECT_EQ(watched.said.exit_code, 2);
  EXPECT_NE(watched.said.err.find("poses.csv:202:1: error: times must increase: 1.66667 s comes "
                                  "after 3.31667 s\n"),
            std::string::npos)
      << watched.said.err;
  EXPECT_NE(watched.said.err.find("100 lines in all, the first: times must increase: 1.66667 s "
                                  "comes after 3.31667 s\n"),
            std::string::npos)
      << watched.said.err;
}

// Also if no entity stands before it in the map.
TEST(WatchMap, AHandThatIsHeldWhileItIsLostPointsWhereItPointed) {
  std::string rows = "t,hand_x,hand_y,hand_z,cup_x,cup_y,cup_z\n";
  for (int i = 0; i < 60; ++i)
    rows += Text(i / 100.0) + (i < 20 || i >= 40 ? ",0,0,0.8" : ",nan,nan,nan") + ",0,0.2,0.8\n";
  const Watched watched =
      Watch(rows,
            "unit: m\naxes: z_up\ntime_unit: s\nmissing: [nan]\nlost: hold\nsure: [unit]\n"
            "columns: {time: t, position: [\"{}_x\", \"{}_y\", \"{}_z\"]}\nentities:\n"
            "  hand: {from: hand, hand: true, ahead: [0, 1, 0], size_m: [0, 0, 0]}\n"
            "  cup: {from: cup, class: Cup, size_m: [0.1, 0.1, 0.1]}\n");
  WriteFile(watched.folder / "g.grammar",
            "grammar g\nevent before(h: Hand, c: Cup)\n"
            "  while distance(ahead(h, 20 cm), position(c)) < 5 cm\n");
  const Said said = Prehend({"grammar", "watch", (watched.folder / "poses.csv").string(), "--map",
                             (watched.folder / "map.yaml").string(), "--grammar",
                             (watched.folder / "g.grammar").string(), "--json"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  const std::vector<Json> found = Lines(said.out);
  ASSERT_EQ(found.size(), 1u) << said.out;
  EXPECT_EQ(found[0]["begin_tick"], 0);
}

TEST(WatchMap, AMapThatIsWrongIsAnErrorAtOnce) {
  const std::string csv = Csv([](int i) { return Row(i); });
  const auto refused = [&](const std::string& map, const std::string& why) {
    const Watched watched = Watch(csv, map);
    EXPECT_EQ(watched.said.exit_code, 2);
    EXPECT_EQ(watched.said.out, "");
    EXPECT_NE(watched.said.err.find(why), std::string::npos) << watched.said.err;
  };
  refused(Replaced(kMap, "from: Cup", "from: Mug"), "no body is called 'Mug'");
  refused(Replaced(kMap, "time: t", "time: when"), "no column is called 'when'");
  refused(Replaced(kMap, "axes: z_up", "axes: up"), "map.yaml:3:7");
  refused(Replaced(kMap, "from: Cup", "markers: [Cup, Hand, Lid]"),
          "the shape of markers is learned from a whole file");
  const Said none = Prehend({"grammar", "watch", "milk_carton_wrap", "--map", "map.yaml"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("--map is for tables of poses"), std::string::npos) << none.err;
}

TEST(WatchMap, WhatHoldsIsPrintedWithinATenthOfASecond) {
  const Watched watched = Watch(Csv([](int i) { return Row(i); }), kMap, {"--json", "--open"});
  EXPECT_EQ(watched.said.exit_code, 0) << watched.said.err;
  std::vector<Json> certain, open;
  for (const Json& line : Lines(watched.said.out))
    (line.contains("certain") ? open : certain).push_back(line);
  EXPECT_EQ(Events(certain),
            Events(Lines(Watch(Csv([](int i) { return Row(i); }), kMap).said.out)));
  ASSERT_FALSE(open.empty());
  std::set<std::string> named;
  for (const Json& line : open) {
    EXPECT_EQ(line["certain"], false);
    if (line["open"] == true) named.insert(line["event"].get<std::string>());
  }
  EXPECT_TRUE(named.contains("grasping")) << watched.said.out;
  EXPECT_TRUE(named.contains("supported_by")) << watched.said.out;
  // The carton lies on the table from the first frame on: that is known at once, and certain only
  // after the lift.
  EXPECT_EQ(open.front()["event"], "contact");
  EXPECT_LE(open.front()["at_tick"].get<int>(), 1000);
  for (const Json& event : certain) {
    if (event["event"] != "grasping") continue;
    const auto seen = std::find_if(open.begin(), open.end(), [&](const Json& line) {
      return line["event"] == "grasping" && line["open"] == true;
    });
    ASSERT_NE(seen, open.end());
    EXPECT_LE((*seen)["at_tick"].get<int>() - event["begin_tick"].get<int>(), 2000)
        << *seen << event;
  }
}

}  // namespace
}  // namespace prehend::house

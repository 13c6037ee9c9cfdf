// SPDX-License-Identifier: Apache-2.0
// A first map that writes itself, for each layout that is known: `import --check` accepts it as it
// is, and once the sizes are filled in, the recording is that of the map that a person would write.
// Takes of a folder, with one map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/program/import_csv.h"
#include "tests/program/layout_files.h"
#include "tests/program/mcap_writer.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

/// The map that is proposed; `--check` accepts it and says what is to be filled in.
std::string Proposed(const fs::path& folder, const std::string& file, const std::string& bytes) {
  WriteFile(folder / file, bytes);
  const std::string poses = (folder / file).string(), map = (folder / "first.yaml").string();
  fs::remove(map);
  const Said said = Prehend({"import", poses, "--propose", "-o", map});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.err, "");
  if (said.exit_code != 0) return "";
  EXPECT_EQ(Prehend({"import", poses, "--check"}).out, ReadFile(map));
  EXPECT_EQ(Prehend({"import", poses, "--propose"}).out, ReadFile(map));
  const Said check = Prehend({"import", poses, "--map", map, "--check"});
  EXPECT_EQ(check.exit_code, 0) << ReadFile(map) << check.err;
  EXPECT_EQ(ReadFile(map).find(" \n"), std::string::npos) << ReadFile(map);
  EXPECT_NE(check.err.find("size_m is unknown, and to be filled in, of "), std::string::npos)
      << check.err;
  return ReadFile(map);
}

/// Sizes as a person fills them in; what the tracker does not see is the table.
std::string FilledIn(std::string map) {
  const std::vector<std::pair<std::string, std::string>> sizes = {{"hand", "[0, 0, 0]"},
                                                                  {"cup", "[0.08, 0.08, 0.1]"}};
  std::string filled;
  std::istringstream lines(map);
  for (std::string line; std::getline(lines, line);) {
    for (const auto& [name, size] : sizes)
      if (line.find("  " + name) == 0 && line.find("size_m: unknown") != std::string::npos)
        line = Replaced(line, "unknown", size);
    if (line.starts_with("  table: "))
      line = "  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, size_m: [2.0, 1.0, 0.04]}";
    filled += line + "\n";
  }
  return filled;
}

/// From the file to its events, as the docs say it.
std::string EventsOf(const std::string& file, const std::string& bytes) {
  const auto folder = FreshFolder("propose");
  const std::string map = (folder / "first.yaml").string(), poses = (folder / file).string(),
                    take = (folder / "take.jsonl").string();
  WriteFile(map, FilledIn(Proposed(folder, file, bytes)));
  const Said import = Prehend({"import", poses, "--map", map, "-o", take});
  EXPECT_EQ(import.exit_code, 0) << ReadFile(map) << import.err;
  const auto said = nlohmann::json::parse(Prehend({"episode", "resegment", take, "--json"}).out);
  std::vector<std::string> events;
  for (const auto& event : said["events"])
    events.push_back(event["event"].get<std::string>() + " " + event["roles"].dump());
  std::ranges::sort(events);
  std::string text;
  for (const std::string& event : events) text += event + "\n";
  EXPECT_NE(text.find("picking_up"), std::string::npos) << ReadFile(map) << text;
  EXPECT_NE(text.find("transporting"), std::string::npos) << ReadFile(map) << text;
  return text;
}

TEST(ImportPropose, EachLayoutHasAFirstMapThatGivesTheSameEvents) {
  const std::string events = EventsOf("take.csv", MotiveCsv({}));
  EXPECT_EQ(EventsOf("take.csv", MotiveCsv({.version = "1.25", .labels = true, .end = "\r\n"})),
            events);
  EXPECT_EQ(EventsOf("take.csv", MotiveCsv({.unit = "Millimeters", .scale = 1000})), events);
  EXPECT_EQ(EventsOf("take.csv", MotiveCsv({.rotation = "XYZ"})), events);
  EXPECT_EQ(EventsOf("take.csv", ViconCsv("Objects", "Quaternion")), events);
  EXPECT_EQ(EventsOf("take.csv", ViconCsv("Segments", "Helical", "deg")), events);
  EXPECT_EQ(EventsOf("take.tsv", QualisysTsv({.six = true})), events);
  // Without orientations.
  EXPECT_EQ(EventsOf("take.csv", ViconCsv("Trajectories", "")), events);
  EXPECT_EQ(EventsOf("take.tsv", QualisysTsv({})), events);
  EXPECT_EQ(EventsOf("take.trc", Trc("Cup\t\t\tHand\t\t", "mm", 1000, "\n")), events);
}

/// A table of the story; the cells of a pose as `pose` writes them.
std::string Plain(const std::string& head, const std::string& separator,
                  const std::function<std::string(int)>& before, double scale, bool y_up,
                  const std::string& turn) {
  return head + "\n" + Rows([&](int i) {
           return before(i) + Three(CupAt(i / kRate_hz), scale, separator, y_up) + turn +
                  separator + Three(HandAt(i / kRate_hz), scale, separator, y_up) + turn;
         });
}

TEST(ImportPropose, PlainTablesAreKnownByTheNamesOfTheirColumns) {
  const std::string events = EventsOf("take.csv", MotiveCsv({}));
  const auto seconds = [](const char* separator) {
    return [=](int i) { return Text(i / kRate_hz) + separator; };
  };
  EXPECT_EQ(EventsOf("take.csv", Plain("t,Cup_x,Cup_y,Cup_z,Hand_x,Hand_y,Hand_z", ",",
                                       seconds(","), 1, false, "")),
            events);
  // Millimetres, y up, tabs, milliseconds, quaternions.
  EXPECT_EQ(EventsOf("take.tsv",
                     Plain(
                         "Timestamp_ms\tCup.pos.x\tCup.pos.y\tCup.pos.z\tCup.rot.x\tCup.rot.y\t"
                         "Cup.rot.z\tCup.rot.w\tHand.pos.x\tHand.pos.y\tHand.pos.z\tHand.rot.x\t"
                         "Hand.rot.y\tHand.rot.z\tHand.rot.w",
                         "\t", [](int i) { return Text(1000 * i / kRate_hz, "%.3f") + "\t"; }, 1000,
                         true, "\t0\t0\t0\t1")),
            events);
  EXPECT_EQ(EventsOf("take.csv", Plain(
                                     "frame;CupX;CupY;CupZ;HandX;HandY;HandZ", ";",
                                     [](int i) { return std::to_string(i) + ";"; }, 1, false, "")
                                     .c_str())
                .empty(),
            false);  // at 30 Hz until the rate is filled in
  std::string rows = "time_s,name,x,y,z,comment\n";
  for (int i = 0; i < kFrames; ++i)
    for (const char* body : {"Cup", "Hand"})
      rows += Text(i / kRate_hz) + "," + body + "," +
              Three(body[0] == 'C' ? CupAt(i / kRate_hz) : HandAt(i / kRate_hz), 1, ",") + ",\n";
  EXPECT_EQ(EventsOf("take.csv", rows), events);
}

TEST(ImportPropose, WhatIsDoubtfulIsSaid) {
  const auto folder = FreshFolder("propose");
  const std::string lost =
      Proposed(folder, "a.csv", MotiveCsv({.lost_from = 100, .lost_until = 200}));
  EXPECT_NE(lost.find("# doubt: 'Hand' is not tracked for 1.683 s"), std::string::npos) << lost;
  EXPECT_NE(lost.find("axes: y_up"), std::string::npos) << lost;
  const std::string lab =
      Proposed(folder, "lab.csv",
               Plain(
                   "t,quality,Cup_x,Cup_y,Cup_z,Wand_x,Wand_y,Wand_z", ",",
                   [](int i) { return Text(i / kRate_hz) + ",1,"; }, 1, true, ""));
  EXPECT_NE(lab.find("# doubt: no body is called a hand"), std::string::npos) << lab;
  EXPECT_NE(lab.find("# doubt: columns that are left aside: quality"), std::string::npos) << lab;
  std::string table = Proposed(folder, "b.csv", MotiveCsv({}));
  EXPECT_NE(table.find("  table: {at_m: ["), std::string::npos) << table;
  EXPECT_NE(table.find("# guessed, below what rests"), std::string::npos) << table;
  const std::string still =
      Proposed(folder, "kitti.txt",
               Rows([](int i) { return "1 0 0 " + Text(0.01 * i) + " 0 1 0 0 0 0 1 0.8"; }));
  EXPECT_NE(still.find("rate_hz: 30             # fill in"), std::string::npos) << still;
}

TEST(ImportPropose, CentimetresMayBeInchesAndUpIsFoundInBoth) {
  const auto folder = FreshFolder("propose");
  const auto table = [](double scale) {
    return Plain(
        "t,Cup_x,Cup_y,Cup_z,Hand_x,Hand_y,Hand_z", ",",
        [](int i) { return Text(i / kRate_hz) + ","; }, scale, true, "");
  };
  const std::string doubt = "# doubt: unit: cm or inch: hands move as far and as fast in both\n";
  for (const double scale : {100.0, 1 / 0.0254}) {
    const std::string map = Proposed(folder, "a.csv", table(scale));
    EXPECT_NE(map.find("unit: cm "), std::string::npos) << map;
    EXPECT_NE(map.find(doubt), std::string::npos) << map;
    EXPECT_NE(map.find("axes: y_up"), std::string::npos) << map;
  }
  for (const double scale : {1.0, 1000.0}) {
    const std::string map = Proposed(folder, "a.csv", table(scale));
    EXPECT_EQ(map.find(doubt), std::string::npos) << map;
  }
}

TEST(ImportPropose, PointsThatAreCountedMayBeMarkersOfOneBody) {
  const auto folder = FreshFolder("propose");
  const auto points = [&](const std::string& names) {
    return Proposed(folder, "a.tsv",
                    "t\t" + names + "\n" + Rows([](int i) {
                      const Row cup = CupAt(i / kRate_hz);
                      return Text(i / kRate_hz) + "\t" + Three(cup, 1, "\t") + "\t" +
                             Three({0, cup.x + 0.05, cup.y, cup.z}, 1, "\t") + "\t" +
                             Three({0, cup.x, cup.y + 0.05, cup.z}, 1, "\t") + "\t" +
                             Three(HandAt(i / kRate_hz), 1, "\t");
                    }));
  };
  const std::string of_one = points(
      "cup_1_x\tcup_1_y\tcup_1_z\tcup_2_x\tcup_2_y\tcup_2_z\tcup_3_x\tcup_3_y\tcup_3_z\t"
      "hand_x\thand_y\thand_z");
  EXPECT_NE(of_one.find("# doubt: are these markers of one body? markers: [\"cup_1\", \"cup_2\", "
                        "\"cup_3\"], in the place of from, gives it orientations\n"),
            std::string::npos)
      << of_one;
  const std::string of_two = points(
      "cup_1_x\tcup_1_y\tcup_1_z\tcup_2_x\tcup_2_y\tcup_2_z\tjar_x\tjar_y\tjar_z\t"
      "hand_x\thand_y\thand_z");
  EXPECT_EQ(of_two.find("markers of one body"), std::string::npos) << of_two;
}

// y down, ahead and 35 degrees down: the cup is lifted along none of its axes.
TEST(ImportPropose, OfACameraThatLooksDownItIsSaidAlongWhatThingsAreLifted) {
  const auto folder = FreshFolder("propose");
  const auto seen = [](const Row& r) {
    return Three({0, r.x, -0.57358 * r.y - 0.81915 * r.z, 0.81915 * r.y - 0.57358 * r.z}, 1, ",") +
           ",0.88701,0,0,0.46175";
  };
  const std::string csv =
      "t,Cup_x,Cup_y,Cup_z,Cup_qx,Cup_qy,Cup_qz,Cup_qw,Hand_x,Hand_y,Hand_z,Hand_qx,Hand_qy,"
      "Hand_qz,Hand_qw\n" +
      Rows([&](int i) {
        return Text(i / kRate_hz) + "," + seen(CupAt(i / kRate_hz)) + "," +
               seen(HandAt(i / kRate_hz));
      });
  const std::string map = Proposed(folder, "a.csv", csv);
  EXPECT_NE(map.find("# doubt: nothing is lifted along up; 'Cup' is carried 0.21 m off the line "
                     "from where it stood to where it stands: if that was up, up: [0.00, -0.82, "
                     "-0.57] in the place of axes\n"),
            std::string::npos)
      << map;
  // The names of the columns say which is w.
  EXPECT_EQ(map.find("this looks like"), std::string::npos) << map;
  const std::size_t axes = map.find("axes: z_up"), table = map.find("  table: ");
  ASSERT_NE(axes, std::string::npos) << map;
  std::string right = map;
  if (table != std::string::npos) right.erase(table, right.find('\n', table) + 1 - table);
  right.replace(axes, 10, "up: [0.00, -0.82, -0.57]");
  const Said said = ImportFile(folder, "a.csv", csv, right);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(said.err.find("this looks like"), std::string::npos) << said.err;
}

TEST(ImportPropose, NamesOfBodiesThatLookLikeSomethingElse) {
  const auto folder = FreshFolder("propose");
  const auto of = [&](const std::string& cup, const std::string& hand) {
    std::string head = "t";
    for (const std::string& body : {cup, hand})
      for (const char* axis : {"_x", "_y", "_z"}) head += "," + body + axis;
    return Proposed(folder, "a.csv",
                    Plain(
                        head, ",", [](int i) { return Text(i / kRate_hz) + ","; }, 1, false, ""));
  };
  const std::string chinese = of("杯", "手");
  EXPECT_NE(chinese.find("  body: {from: \"杯\", class: Body, size_m: unknown}\n"),
            std::string::npos)
      << chinese;
  EXPECT_NE(chinese.find("  body_2: {from: \"手\", class: Body, size_m: unknown}\n"),
            std::string::npos)
      << chinese;
  const std::string no_name = of("y", "hand");  // "y" is true or false in YAML
  EXPECT_NE(no_name.find("  body_y: {from: \"y\""), std::string::npos) << no_name;
  const std::string doubt = "# doubt: 'hand_cream' is a hand by its name";
  const std::string cream = of("hand_cream", "hand_r");
  EXPECT_NE(cream.find(doubt), std::string::npos) << cream;
  EXPECT_EQ(cream.find("# doubt: 'hand_r'"), std::string::npos) << cream;
}

TEST(ImportPropose, SkeletonsAndMessages) {
  const auto folder = FreshFolder("propose");
  const std::string docs = PREHEND_SOURCE_DIR "/docs/motion_capture/";
  const std::string bvh = Proposed(folder, "take.bvh", ReadFile(docs + "take.bvh"));
  EXPECT_NE(bvh.find("unit: cm"), std::string::npos) << bvh;
  EXPECT_NE(bvh.find("  right_hand: {from: \"RightHand\", hand: true, size_m: unknown}"),
            std::string::npos)
      << bvh;
  EXPECT_EQ(bvh.find("  right_arm: "), std::string::npos) << bvh;
  const std::string mcap = Proposed(folder, "run.mcap", ReadFile(docs + "run.mcap"));
  EXPECT_NE(mcap.find("from: \"carton\""), std::string::npos) << mcap;
  EXPECT_NE(mcap.find("from: \"glove\", hand: true"), std::string::npos) << mcap;
}

TEST(ImportPropose, NoMapWithoutColumnsAndNothingIsReplaced) {
  const auto folder = FreshFolder("propose");
  const std::string poses = (folder / "a.csv").string(), map = (folder / "m.yaml").string();
  WriteFile(poses, "when,what\n1,2\n2,3\n");
  const Said said = Prehend({"import", poses, "--propose", "-o", map});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("no columns are called x, y and z"), std::string::npos) << said.err;
  EXPECT_FALSE(fs::exists(map));
  EXPECT_EQ(Prehend({"import", poses, "--propose", "--map", map}).exit_code, 2);
  EXPECT_EQ(Prehend({"import", poses, "--propose", "-o", poses}).exit_code, 2);
  EXPECT_EQ(ReadFile(poses), "when,what\n1,2\n2,3\n");
  for (const auto& [other, why] :
       {std::pair("a.json", "nothing in it is called as a position or a pose"),
        {"a.jsonl", "nothing in it is called as a position or a pose"},
        {"a.npz", "it is no .npz file"},
        {"a.c3d", "it is no C3D file"}}) {
    WriteFile(folder / other, other[2] == 'j' ? "{}\n" : "PK");
    const Said refused = Prehend({"import", (folder / other).string(), "--propose", "-o", map});
    EXPECT_EQ(refused.exit_code, 2) << other;
    EXPECT_NE(refused.err.find(why), std::string::npos) << other << refused.err;
    EXPECT_FALSE(fs::exists(map)) << other;
  }
}

TEST(ImportPropose, AMapThatSomebodyChangedIsNotReplaced) {
  const auto folder = FreshFolder("propose");
  const std::string poses = (folder / "a.csv").string(), map = (folder / "m.yaml").string();
  WriteFile(poses, MotiveCsv({}));
  const std::vector<std::string> propose = {"import", poses, "--propose", "-o", map};
  EXPECT_EQ(Prehend(propose).exit_code, 0);
  EXPECT_EQ(Prehend(propose).exit_code, 0);  // it is the same
  WriteFile(map, ReadFile(map) + "# filled in\n");
  const Said said = Prehend(propose);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find(map + " is there, and has another content: wanted a new name, or - to "
                                "print"),
            std::string::npos)
      << said.err;
  EXPECT_TRUE(ReadFile(map).ends_with("# filled in\n"));
}

// One body with markers on its slanted lid: no plane that things rest on.
TEST(ImportPropose, MarkersOfOneBodyAreNoThingsOnAPlane) {
  std::string csv = "t";
  for (const char* name : {"box1", "box2", "box3", "box4", "box5", "hand"})
    for (const char* axis : {"_x", "_y", "_z"}) csv += "," + std::string(name) + axis;
  csv += "\n";
  for (int i = 0; i < 180; ++i) {
    csv += std::to_string(i / 30.0);
    for (const auto& [x, y] :
         {std::pair(0.0, 0.0), {0.3, 0.0}, {0.0, 0.3}, {0.3, 0.3}, {0.15, 0.1}})
      csv +=
          "," + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(0.8 + 0.5 * x);
    csv += "," + std::to_string(0.3 + 0.5 * std::sin(i / 30.0)) + ",0.1,1.1\n";
  }
  const auto folder = FreshFolder("propose");
  WriteFile(folder / "a.csv", csv);
  const Said said = Prehend({"import", (folder / "a.csv").string(), "--propose"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("are these markers of one body?"), std::string::npos) << said.out;
  EXPECT_EQ(said.out.find(" rest"), said.out.find(" rests\n")) << said.out;  // the guessed table
}

// A lost cup is all zeros, its orientation, too, in 30 of 150 frames.
TEST(ImportPropose, ZerosOfALostBodyAreNoPose) {
  std::string csv =
      "time,cup_x,cup_y,cup_z,cup_qx,cup_qy,cup_qz,cup_qw,"
      "hand_x,hand_y,hand_z,hand_qx,hand_qy,hand_qz,hand_qw\n";
  for (int i = 0; i < 150; ++i)
    csv += std::to_string(i / 30.0) +
           (i >= 60 && i < 90 ? ",0,0,0,0,0,0,0" : ",0.2,0.3,0.8,0,0,0,1") + "," +
           std::to_string(0.2 + 0.3 * std::sin(i / 30.0)) + ",0.3,0.9,0,0,0,1\n";
  const auto folder = FreshFolder("propose");
  const std::string map = Proposed(folder, "a.csv", csv);
  EXPECT_NE(
      map.find("zero_is_missing: true   # 30 poses at exactly 0, 0, 0, which count as lost\n"),
      std::string::npos)
      << map;
  // What is no orientation anywhere else stays an error.
  std::string wrong = csv;
  wrong.replace(wrong.find(",0.2,0.3,0.8,0,0,0,1"), 20, ",0.2,0.3,0.8,0,0,0,0");
  WriteFile(folder / "b.csv", wrong);
  const Said said = Prehend({"import", (folder / "b.csv").string(), "--propose"});
  EXPECT_EQ(said.exit_code, 2) << said.out;
  EXPECT_NE(said.err.find("b.csv:2:"), std::string::npos) << said.err;
}

TEST(ImportPropose, LandmarksOfAHandAreOneHand) {
  std::string csv = "time,hand,landmark,x,y,z\n";
  for (int i = 0; i < 90; ++i) {
    const std::string t = std::to_string(i / 30.0),
                      x = std::to_string(0.2 + 0.3 * std::sin(i / 30.0));
    for (const char* side : {"Right", "Left"})
      for (int k = 0; k <= 20; ++k)
        csv += t + "," + side + "," + std::to_string(k) + "," + x + "," + std::to_string(0.01 * k) +
               (side[0] == 'R' ? ",1.1\n" : ",1.3\n");
    csv += t + ",obj,cup,0.2,0.3,0.8\n";
  }
  const auto folder = FreshFolder("propose");
  const std::string map = Proposed(folder, "a.csv", csv);
  for (const char* line : {"  right_hand: {from: \"Right/9\", hand: true, size_m: unknown}\n",
                           "  left_hand: {from: \"Left/9\", hand: true, size_m: unknown}\n",
                           "  obj_cup: {from: \"obj/cup\", class: ObjCup, size_m: unknown}\n"})
    EXPECT_NE(map.find(line), std::string::npos) << map;
  EXPECT_EQ(map.find("right_0"), std::string::npos) << map;
  // Those that no map mentions are one line.
  const Said said = ImportCsv(folder, csv, map);
  EXPECT_NE(said.err.find("warning: the file has 'Right/0', 'Right/1', "), std::string::npos);
  EXPECT_NE(said.err.find(" and 20 more, which the map does not mention\n"), std::string::npos)
      << said.err;
}

TEST(ImportPropose, TakesOfAFolderWithOneMap) {
  const auto folder = FreshFolder("propose");
  fs::create_directory(folder / "takes");
  const std::string map = (folder / "map.yaml").string(), takes = (folder / "takes").string();
  for (const char* name : {"a", "b", "d"})
    WriteFile(folder / "takes" / (name + std::string(".csv")), MotiveCsv({}));
  WriteFile(folder / "takes" / "c.csv", MotiveCsv({}).substr(0, 9000));
  WriteFile(folder / "takes" / "notes.md", "Lunch at noon.\n");
  WriteFile(folder / "takes" / "e.csv", "Lunch at noon.\n");
  WriteFile(map, FilledIn(Proposed(folder, "first.csv", MotiveCsv({}))));
  const std::string out = (folder / "out").string();
  const Said said = Prehend({"import", takes, "--map", map, "-o", out});
  EXPECT_EQ(said.exit_code, 1) << said.err;
  // Each with its reasons, one after the other.
  const std::size_t cut = said.err.find("prehend: left out: " + takes + "/c.csv:\n"),
                    other = said.err.find("prehend: left out: " + takes + "/e.csv:\n");
  EXPECT_NE(other, std::string::npos) << said.err;
  EXPECT_LT(said.err.find("is the file cut off?", cut), other) << said.err;
  EXPECT_NE(said.out.find("\na        301     5.00     0.00\n"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("3 of 5 takes; left out: " + takes + "/c.csv, " + takes + "/e.csv"),
            std::string::npos)
      << said.out;
  for (const char* name : {"a", "b", "d"})
    EXPECT_TRUE(fs::exists(folder / "out" / (name + std::string(".jsonl"))));
  EXPECT_FALSE(fs::exists(folder / "out" / "c.jsonl"));
  // Into one episode file, and nowhere.
  const std::string episodes = (folder / "all.episodes").string();
  EXPECT_EQ(Prehend({"import", takes + "/a.csv", takes + "/b.csv", "--map", map, "-o", episodes})
                .exit_code,
            0);
  const Said list = Prehend({"episode", "list", episodes});
  EXPECT_NE(list.out.find("\n"), std::string::npos);
  EXPECT_EQ(Prehend({"import", takes, "--map", map, "--check"}).exit_code, 1);
  // One take of a folder goes to a folder, too; demonstrations go alone.
  fs::create_directory(folder / "one");
  WriteFile(folder / "one" / "a.csv", MotiveCsv({}));
  const std::string one = (folder / "one").string();
  EXPECT_EQ(Prehend({"import", one, "--map", map, "-o", out + "1"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(out + "1/a.jsonl"));
  WriteFile(folder / "one" / "demos.h5", "");
  const Said mixed = Prehend({"import", one, "--map", map, "--check"});
  EXPECT_EQ(mixed.exit_code, 1);
  EXPECT_NE(mixed.err.find("demonstrations in HDF5 are imported alone"), std::string::npos)
      << mixed.err;
  const Said file = Prehend({"import", takes, "--map", map, "-o", out + ".csv"});
  EXPECT_NE(file.err.find("of several takes it is a folder or NAME.episodes"), std::string::npos);
  EXPECT_FALSE(fs::exists(out + ".csv"));
  // A map that is wrong for all.
  WriteFile(map, "import: 1\naxes: y_up\nentities:\n  mug: {from: Mug, size_m: [0.1, 0.1, 0.1]}\n");
  EXPECT_EQ(Prehend({"import", takes, "--map", map, "-o", out + "2"}).exit_code, 2);
}

TEST(ImportPropose, NamesThatMeanSomethingElseAreNoHindrance) {
  const std::string long_name = "marker_cluster_" + std::string(60, 'a') + "_on_the_cup";
  for (const std::string& name :
       {std::string("Camera"), std::string("LIGHT"), std::string("any"), std::string("body_part"),
        std::string("gaze_target"), long_name}) {
    Proposed(FreshFolder("propose_names"), "take.csv",
             Plain(
                 "t," + name + "_x," + name + "_y," + name + "_z,Hand_x,Hand_y,Hand_z", ",",
                 [](int i) { return Text(i / kRate_hz) + ","; }, 1, false, ""));
  }
}

}  // namespace
}  // namespace prehend::house

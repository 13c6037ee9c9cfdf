// SPDX-License-Identifier: Apache-2.0
// Tables as trackers export them: the same cup and hand, written in each layout and its variants,
// become the same recording; what is wrong with one is said as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <tuple>

#include "tests/program/import_csv.h"
#include "tests/program/layout_files.h"

namespace prehend::house {
namespace {

std::string Entities(const char* cup = "Cup", const char* hand = "Hand") {
  return std::string(
             "entities:\n  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, "
             "size_m: [2.0, 1.0, 0.04]}\n  cup: {from: \"") +
         cup + "\", class: Cup, size_m: [0.08, 0.08, 0.1]}\n  hand: {from: \"" + hand +
         "\", hand: true, size_m: [0, 0, 0]}\n";
}

struct Take {
  Said said;
  std::string frames;  ///< of the recording, without its head
};

Take Import(const std::string& file, const std::string& bytes, const std::string& map) {
  const auto folder = FreshFolder("layouts");
  Take take{.said = ImportFile(folder, file, bytes, "import: 1\nepisode: take\n" + map)};
  if (take.said.exit_code == 0)
    take.frames = Prehend({"episode", "resegment", (folder / "take.jsonl").string()}).out;
  return take;
}

/// What is done in all of them.
const std::string& Carried() {
  static const std::string events = [] {
    std::string csv = "t,Cup_x,Cup_y,Cup_z,Hand_x,Hand_y,Hand_z\n";
    csv += Rows([](int i) {
      const Row c = CupAt(i / kRate_hz), h = HandAt(i / kRate_hz);
      return Text(i / kRate_hz) + "," + Text(c.x) + "," + Text(c.y) + "," + Text(c.z) + "," +
             Text(h.x) + "," + Text(h.y) + "," + Text(h.z);
    });
    return Import("poses.csv", csv,
                  "unit: m\naxes: z_up\ntime_unit: s\ncolumns: {time: t, position: [\"{}_x\", "
                  "\"{}_y\", \"{}_z\"]}\n" +
                      Entities())
        .frames;
  }();
  EXPECT_NE(events.find("transporting"), std::string::npos) << events;
  return events;
}

void ExpectCarried(const std::string& file, const std::string& bytes, const std::string& map) {
  const Take take = Import(file, bytes, map);
  EXPECT_EQ(take.said.exit_code, 0) << take.said.err;
  EXPECT_EQ(take.frames, Carried()) << take.said.err;
}

void ExpectRefused(const std::string& file, const std::string& bytes, const std::string& map,
                   const std::string& why) {
  const Take take = Import(file, bytes, map);
  EXPECT_EQ(take.said.exit_code, 2);
  EXPECT_NE(take.said.err.find(why), std::string::npos) << take.said.err;
}

// ---------------------------------------------------------------------------------------- Motive

const std::string kMotiveMap = "axes: y_up\n" + Entities();

TEST(ImportLayouts, MotiveInAllItsVersions) {
  ExpectCarried("take.csv", MotiveCsv({}), kMotiveMap);
  ExpectCarried("take.csv", MotiveCsv({.version = "1.25", .labels = true, .end = "\r\n"}),
                kMotiveMap);
  ExpectCarried("take.csv", MotiveCsv({.unit = "Millimeters", .scale = 1000}), kMotiveMap);
  ExpectCarried("take.csv", "\xEF\xBB\xBF" + MotiveCsv({.unit = "Centimeters", .scale = 100}),
                kMotiveMap);
  ExpectCarried("take.csv", MotiveCsv({.rotation = "XYZ"}), kMotiveMap);
  // What is lost for three frames is bridged.
  ExpectCarried("take.csv", MotiveCsv({.lost_from = 2, .lost_until = 5}), kMotiveMap);
}

TEST(ImportLayouts, MotiveIsRefusedForTheTrueReason) {
  ExpectRefused("take.csv", MotiveCsv({}), "axes: y_up\nunit: mm\n" + Entities(),
                "'unit' contradicts the file");
  ExpectRefused("take.csv", MotiveCsv({}), "axes: y_up\n" + Entities("Mug"),
                "no body is called 'Mug' in a CSV file of Motive");
  ExpectRefused("take.csv", MotiveCsv({.lost_from = 100, .lost_until = 200}), kMotiveMap,
                "'Hand' is not tracked for");
  ExpectRefused("take.csv", MotiveCsv({.unit = "Furlongs"}), kMotiveMap,
                "needs one of the keys unit");
  std::string cut = MotiveCsv({});
  cut.resize(cut.size() - 30);
  ExpectRefused("take.csv", cut, kMotiveMap, "is the file cut off?");
}

TEST(ImportLayouts, ColumnsOfAMapAreNotUsedWhereTheHeadSaysMore) {
  const Take take = Import("take.csv", MotiveCsv({}),
                           "unit: m\nquaternion_order: xyzw\nheader_line: 7\ntime_unit: s\n"
                           "columns: {time: Time (Seconds), position: [\"{} X\", \"{} Y\", "
                           "\"{} Z\"]}\n" +
                               kMotiveMap);
  EXPECT_EQ(take.said.exit_code, 0) << take.said.err;
  EXPECT_NE(take.said.err.find("'columns' of the map is not used"), std::string::npos);
  EXPECT_EQ(take.frames, Carried());
}

// ----------------------------------------------------------------------------------------- Vicon

TEST(ImportLayouts, ViconTrackerAndNexus) {
  const std::string map = "axes: z_up\n" + Entities("s:Cup", "s:Hand");
  ExpectCarried("take.csv", ViconCsv("Objects", "Helical"), map);
  ExpectCarried("take.csv", ViconCsv("Objects", "Quaternion"), map);
  ExpectCarried("take.csv", ViconCsv("Segments", "Helical", "deg"), map);
  ExpectCarried("take.csv", ViconCsv("Objects", "Euler", "deg"), map + "euler_order: XYZ\n");
  ExpectCarried("take.csv", ViconCsv("Trajectories", ""), map);
  ExpectCarried("take.csv", ViconCsv("Trajectories", "", "", ";"), map);
  // Forces before, other parts behind.
  ExpectCarried("take.csv",
                "Devices\n1000\n,,Plate,,\nFrame,Sub Frame,Fx,Fy,Fz\n,,N,N,N\n1,0,1,2,3\n\n" +
                    ViconCsv("Objects", "Helical") + "\nTrajectories\n60\n,,M\n",
                map);
  ExpectRefused("take.csv", ViconCsv("Objects", "Helical"), map + "rate_hz: 100\n",
                "'rate_hz' contradicts the file");
}

// -------------------------------------------------------------------------------------- Qualisys

TEST(ImportLayouts, QualisysIn3DAnd6D) {
  const std::string map = "axes: z_up\n" + Entities();
  ExpectCarried("take.tsv", QualisysTsv({}), map);
  ExpectCarried("take.tsv", QualisysTsv({.tab = false}), map);
  ExpectCarried("take.tsv", QualisysTsv({.head = false}), map);
  ExpectCarried("take.tsv", QualisysTsv({.six = true}), map);
  ExpectCarried("take.tsv", QualisysTsv({.six = true, .head = false}), map);
  ExpectCarried("take.tsv", QualisysTsv({.six = true, .by_rows = true}), map);
  ExpectCarried("take.tsv", QualisysTsv({.lost_from = 2, .lost_until = 5}), map);
  ExpectRefused("take.tsv", QualisysTsv({.lost_from = 100, .lost_until = 200}), map,
                "'Hand' is not tracked for");
}

// ------------------------------------------------------------------- TRC, TUM, EuRoC, KITTI, own

TEST(ImportLayouts, Trc) {
  const std::string map = "axes: y_up\n" + Entities();
  ExpectCarried("take.trc", Trc("Cup\t\t\tHand\t\t", "mm", 1000, "\n"), map);
  ExpectCarried("take.trc", Trc("Cup\t\t\tHand\t\t\t", "m", 1, ""), map);
  ExpectCarried("take.trc", Trc("Cup\t\tHand", "mm", 1000, "\t\n"), map);
  ExpectRefused("take.trc", Trc("Cup\t\t\tHand", "m", 1000, ""), "unit: mm\n" + map,
                "'unit' contradicts the file: a TRC file says otherwise");
}

/// One body; its poses at 60 Hz, 30 degrees turned, as the table of import says them.
void ExpectCupOnly(const std::string& file, const std::string& bytes, const std::string& map) {
  const auto folder = FreshFolder("layouts");
  const Said said =
      ImportFile(folder, file, bytes,
                 "import: 1\nentities:\n  cup: {from: take, class: Cup, size_m: [0.08, 0.08, 0.1], "
                 "upright_at_s: 0}\n" +
                     map,
                 {"--check"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("take                 301    60.0 "), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("0.00..0.40"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("[0.96593, 0.00000, 0.00000, -0.25882]"), std::string::npos) << said.out;
}

TEST(ImportLayouts, FilesOfOneBody) {
  const double a = kTurn_deg * 3.14159265358979 / 180;
  const std::string z = Text(std::sin(a / 2)), w = Text(std::cos(a / 2));
  const auto rows = [&](const std::function<std::string(double, std::string)>& row,
                        const std::string& separator) {
    return Rows([&](int i) { return row(i / kRate_hz, Three(CupAt(i / kRate_hz), 1, separator)); });
  };
  const auto tum = [&](double t, const std::string& p) {
    return Text(1767225600 + t) + " " + p + " 0 0 " + z + " " + w;
  };
  ExpectCupOnly("take.txt", "# timestamp tx ty tz qx qy qz qw\n" + rows(tum, " "), "axes: z_up\n");
  ExpectCupOnly("take.tum", rows(tum, " "), "axes: z_up\n");
  // The map has the last word of what has no head.
  ExpectCupOnly("take.txt", "# ground truth\n# t x y z a b c d\n" + rows(tum, " "),
                "axes: z_up\nunit: m\ntime_unit: s\nseparator: space\nquaternion_order: xyzw\n"
                "columns: {time: t, position: [x, 'y', z], quaternion: [a, b, c, d]}\n");
  ExpectCupOnly("take.csv",
                "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],"
                "q_RS_y [],q_RS_z []\n" +
                    rows(
                        [&](double t, const std::string& p) {
                          return std::to_string(1403636579758555392 + std::llround(t * 1e9)) + "," +
                                 p + "," + w + ",0,0," + z;
                        },
                        ","),
                "axes: z_up\n");
  const std::string c = Text(std::cos(a)), s = Text(std::sin(a));
  ExpectCupOnly("take.txt", Rows([&](int i) {
                  const Row r = CupAt(i / kRate_hz);
                  return c + " -" + s + " 0 " + Text(r.x) + " " + s + " " + c + " 0 " + Text(r.y) +
                         " 0 0 1 " + Text(r.z);
                }),
                "axes: z_up\nrate_hz: 60\n");
  // No layout: plus signs, decimal commas, dates, angles.
  std::string own =
      "time;x;y;z;rz;ry;rx;\n" + rows(
                                     [&](double t, std::string p) {
                                       p = Text(t, "2026-01-31T10:00:%09.6fZ;+") + p + ";30,0;0;0;";
                                       return p;
                                     },
                                     ";");
  for (std::size_t at = own.find('\n'); at < own.size(); ++at)
    if (own[at] == '.' && own[at + 7] != 'Z') own[at] = ',';
  ExpectCupOnly("take.csv", own,
                "axes: z_up\nunit: m\ntime_unit: iso\nseparator: semicolon\ndecimal: comma\n"
                "euler_order: ZYX\nangle_unit: deg\n"
                "columns: {time: time, position: [x, 'y', z], euler: [rz, ry, rx]}\n");
  ExpectRefused("take.txt", rows(tum, " "), "axes: z_up\n" + Entities(),
                "which is called as the file, 'take'");
}

/// Whether the cup is read, 301 poses at 60 Hz, or refused for this reason.
void ExpectCup(const std::string& file, const std::string& bytes, const std::string& map,
               const std::string& why = {}) {
  const Said said = ImportFile(FreshFolder("layouts"), file, bytes,
                               "import: 1\naxes: z_up\nentities:\n  cup: {from: take, class: Cup, "
                               "size_m: [0.08, 0.08, 0.1]}\n" +
                                   map,
                               {"--check"});
  EXPECT_EQ(said.exit_code, why.empty() ? 0 : 2) << file << said.err;
  if (why.empty())
    EXPECT_NE(said.out.find("301    60.0 "), std::string::npos) << said.out << said.err;
  else
    EXPECT_NE(said.err.find(why), std::string::npos) << said.err;
}

std::string WithCrLf(const std::string& text) {
  std::string all;
  for (const char c : text) all += c == '\n' ? "\r\n" : std::string(1, c);
  return all;
}

std::string Separated(std::string text, char by) {
  std::ranges::replace(text, ' ', by);
  return text;
}

TEST(ImportLayouts, VariantsOfEuroc) {
  const auto row = [](int i, const std::string& more) {
    return std::to_string(1403636579758555392 + std::llround(i / kRate_hz * 1e9)) + "," +
           Three(CupAt(i / kRate_hz), 1, ",") + more;
  };
  const auto rows = [&](const std::string& more) {
    return Rows([&](int i) { return row(i, more); });
  };
  const std::string head = "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n",
                    still = ",1,0,0,0";
  ExpectCup("take.csv", head + rows(still), "");
  ExpectCup("take.csv", WithCrLf(head + rows(still)), "");
  ExpectCup("take.csv", "\xEF\xBB\xBF" + head + rows(still), "");
  ExpectCup(
      "take.csv",
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1], b_w_RS_S_x [rad s^-1]\n" +
          rows(still + ",0,0"),
      "");
  // Without a rate, and a blank behind the sign.
  ExpectCup("take.csv", "# " + head.substr(1) + rows(still), "");
  ExpectCup("take.csv", "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m]\n" + rows(""), "");
  ExpectCup("take.csv", head + rows(still), "unit: mm\n", "contradicts the file");
  ExpectCup("take.csv", (head + rows(still)).substr(0, 9000), "", "is the file cut off?");
  ExpectCup("take.csv", head + rows(",0,0,0,0"), "", "expected a unit quaternion");
  std::string gap = head;
  for (int i = 0; i < kFrames; ++i)
    if (i < 100 || i > 150) gap += row(i, still) + "\n";
  ExpectCup("take.csv", gap, "", "is not tracked for 0.867 s");
}

TEST(ImportLayouts, TimesOfDayPassMidnight) {
  const auto clock = [](int i, const char* hour = "%02.0f:") {
    const double t = std::fmod(86'398 + i / kRate_hz, 86'400);
    return Text(std::floor(t / 3600), hour) + Text(std::fmod(std::floor(t / 60), 60), "%02.0f:") +
           Text(std::fmod(t, 60), "%09.6f");
  };
  std::string csv = "when,x,y,z\n", one_digit = csv, json;
  for (int i = 0; i < kFrames; ++i) {
    const std::string three = Three(CupAt(i / kRate_hz), 1, ",");
    csv += clock(i) + "," + three + "\n";
    one_digit += clock(i, "%.0f:") + "," + three + "\n";
    json += "{\"when\": \"" + clock(i) + "\", \"p\": [" + three + "]}\n";
  }
  const std::string map = "unit: m\ntime_unit: iso\n";
  for (const std::string& hours : {csv, one_digit})
    ExpectCup("take.csv", hours, map + "columns: {time: when, position: [x, 'y', z]}\n");
  const Said said =
      ImportFile(FreshFolder("layouts"), "take.ndjson", json,
                 "import: 1\naxes: z_up\nt: when\n" + map +
                     "entities:\n  cup: {position: p, class: Cup, size_m: [0.08, 0.08, "
                     "0.1]}\n",
                 {"--check"});
  EXPECT_NE(said.out.find("301    60.0 "), std::string::npos) << said.out << said.err;
}

TEST(ImportLayouts, VariantsOfTumAndKitti) {
  const auto tum = [](const char* time, const std::string& turn) {
    return Rows([&](int i) {
      return Text(1767225600 + i / kRate_hz, time) + " " + Three(CupAt(i / kRate_hz), 1, " ") +
             turn;
    });
  };
  const std::string plain = tum("%.6f", " 0 0 0 1");
  ExpectCup("take.txt", tum("%.18e", " 0 0 0 1"), "");
  ExpectCup("take.txt", WithCrLf("# t\n" + plain), "");
  ExpectCup("take.txt", Separated(plain, '\t'), "");
  ExpectCup("take.csv", Separated(plain, ','), "");
  ExpectCup("take.txt", "# a\n" + plain + "# the end\n", "");
  ExpectCup("take.txt", tum("%.6f", " 0 0 0 0"), "", "expected a unit quaternion");
  ExpectCup("take.txt", plain + "1767225600.5 0 0 0.8 0 0 0 1\n", "", "the times must increase");
  ExpectCup("take.txt", plain.substr(0, 9000), "", "is the file cut off?");
  const auto kitti = [](const std::string& first, const char* number = "%.6f") {
    return Rows([&](int i) {
      const Row r = CupAt(i / kRate_hz);
      return first + " 0 0 " + Text(r.x, number) + " 0 1 0 " + Text(r.y, number) + " 0 0 1 " +
             Text(r.z, number);
    });
  };
  const std::string rate = "rate_hz: 60\n";
  ExpectCup("take.txt", kitti("1"), rate);
  ExpectCup("take.txt", kitti("1.000000e+00", "%e"), rate);
  ExpectCup("take.txt", WithCrLf("# poses\n" + kitti("1")), rate);
  ExpectCup("take.txt", Separated(kitti("1"), '\t'), rate);
  ExpectCup("take.csv", Separated(kitti("1"), ','), rate);
  ExpectCup("take.txt", kitti("1"), "", "neither columns.time nor rate_hz");
  ExpectCup("take.txt", kitti("2"), rate, "expected a rotation matrix");
  ExpectCup("take.txt", kitti("-1"), rate, "one that mirrors");
}

TEST(ImportLayouts, VariantsOfTrc) {
  const std::string map = "axes: y_up\n" + Entities(), names = "Cup\t\t\tHand\t\t";
  const auto lost = [&](int from, int until, const char* blank) {
    std::istringstream lines(Trc(names, "mm", 1000, "\n"));
    std::string all;
    int row = -6;
    for (std::string line; std::getline(lines, line); ++row) {
      if (row >= from && row < until) {
        for (int k = 0; k < 3; ++k) line.resize(line.rfind('\t'));
        for (int k = 0; k < 3; ++k) line += std::string("\t") + blank;
      }
      all += line + "\n";
    }
    return all;
  };
  ExpectCarried("take.trc", WithCrLf(Trc(names, "mm", 1000, "\n")), map);
  ExpectCarried("take.trc", Trc(names, "cm", 100, "\n"), map);
  ExpectCarried("take.trc", lost(2, 5, ""), map);
  ExpectCarried("take.trc", lost(2, 5, "NaN"), map);
  ExpectRefused("take.trc", lost(100, 200, ""), map, "'Hand' is not tracked for");
  ExpectRefused("take.trc", Trc(names, "mm", 1000, "\n"), "axes: y_up\n" + Entities("Cup", "Wrist"),
                "no body is called 'Wrist' in a TRC file");
}

TEST(ImportLayouts, RowsOfBodiesWithoutTimesAndWithTwoNames) {
  const auto row = [](const char* name, int i, const Row& r) {
    return std::to_string(i) + "," + name + "," + Three(r, 1, ",") + "\n";
  };
  std::string csv = "frame,hand,landmark,x,y,z\n", apart = csv;
  for (int i = 0; i < kFrames; ++i)
    csv += row("Left,8", i, CupAt(i / kRate_hz)) + row("Right,0", i, HandAt(i / kRate_hz));
  for (int i = 0; i < kFrames; ++i) apart += row("Left,8", i, CupAt(i / kRate_hz));
  for (int i = 0; i < kFrames; ++i) apart += row("Right,0", i, HandAt(i / kRate_hz));
  const std::string map = "unit: m\naxes: z_up\nrate_hz: 60\n" + Entities("Left/8", "Right/0") +
                          "columns: {body: [hand, landmark], position: [x, 'y', z]";
  ExpectCarried("poses.csv", csv, map + "}\n");
  ExpectCarried("poses.csv", apart, map + "}\n");
  ExpectCarried("poses.csv", csv, map + ", time: frame}\ntime_unit: frame\n");
}

// ------------------------------------------------------------------------- heads, and what is
// there

TEST(ImportLayouts, AHeadMayBeLongAndItsBestPartTheLast) {
  const std::string map = "axes: z_up\n" + Entities("s:Cup", "s:Hand");
  std::string devices = "Devices\n1000\n,,Plate,,\nFrame,Sub Frame,Fx,Fy,Fz\n,,N,N,N\n";
  for (int i = 0; i < 100; ++i) devices += std::to_string(i) + ",0,1,2,3\n";
  std::string wrong = ViconCsv("Trajectories", "");  // with other places, so that it is told
  for (std::size_t at = 0; (at = wrong.find(",mm,", at)) != std::string::npos; ++at)
    wrong.replace(at, 4, ",cm,");
  ExpectCarried("take.csv", devices + "\n" + ViconCsv("Objects", "Quaternion"), map);
  ExpectCarried("take.csv", wrong + "\n" + ViconCsv("Objects", "Quaternion"), map);
  ExpectCarried("take.csv", wrong + "\r\n" + WithCrLf(ViconCsv("Segments", "Quaternion")), map);
  // Behind more rows of forces than are looked at for a head.
  std::string many = devices;
  while (many.size() < (std::size_t{5} << 20)) many += std::string(devices, devices.find("0,0,1"));
  ExpectCarried("take.csv", many + "\n" + ViconCsv("Objects", "Quaternion"), map);
  std::string events, comments;
  for (int i = 0; i < 100; ++i) {
    events += "EVENT\tE" + std::to_string(i) + "\t1\t0.1\n";
    comments += "# line " + std::to_string(i) + "\n";
  }
  ExpectCarried("take.tsv", Replaced(QualisysTsv({}), "DESCRIPTION", events + "DESCRIPTION"),
                "axes: z_up\n" + Entities());
  ExpectCup("take.txt", comments + Rows([](int i) {
                          return Text(1767225600 + i / kRate_hz) + " " +
                                 Three(CupAt(i / kRate_hz), 1, " ") + " 0 0 0 1";
                        }),
            "");
}

TEST(ImportLayouts, WhatAHeadSaysAndIsNotSoIsTold) {
  const auto said = [](const std::string& file, const std::string& bytes, const std::string& map) {
    const Take take = Import(file, bytes, map);
    EXPECT_EQ(take.said.exit_code, 0) << take.said.err;
    return take.said.err;
  };
  const auto cut = [](const std::string& bytes) {  // behind a row
    return bytes.substr(0, bytes.rfind('\n', bytes.size() * 9 / 10) + 1);
  };
  const std::string y_up = "axes: y_up\n" + Entities(), z_up = "axes: z_up\n" + Entities(),
                    trc = Trc("Cup\t\t\tHand\t\t", "mm", 1000, "\n"),
                    motive = Replaced(MotiveCsv({}), "Rotation Type",
                                      "Total Frames in Take,900,Total Exported Frames,301,Rotation "
                                      "Type");
  const auto expect = [&](const std::string& err, const std::string& text) {
    EXPECT_NE(err.find("warning: the head says " + text), std::string::npos) << err;
  };
  for (const auto& [file, bytes, map] : {std::tuple("take.trc", trc, y_up),
                                         {"take.csv", motive, y_up},
                                         {"take.tsv", QualisysTsv({}), z_up}}) {
    EXPECT_EQ(said(file, bytes, map).find("head"), std::string::npos);
    const std::string err = said(file, cut(bytes), map);
    expect(err, "301 frames, 2");
    EXPECT_NE(err.find("are there: is the file cut off?"), std::string::npos) << err;
  }
  const std::string rate = "30 frames a second, but poses are 0.01667 s apart: 60 Hz";
  expect(said("take.trc", Replaced(trc, "\n60\t60\t", "\n30\t60\t"), y_up), rate);
  expect(said("take.csv", Replaced(motive, "Export Frame Rate,60", "Export Frame Rate,30"), y_up),
         rate);
  expect(said("take.tsv", Replaced(QualisysTsv({}), "FREQUENCY\t60", "FREQUENCY\t30"), z_up), rate);
  // A rate of 0 is none.
  const std::string vicon = Replaced(ViconCsv("Objects", "Helical"), "Objects\n60", "Objects\n0"),
                    map = "axes: z_up\n" + Entities("s:Cup", "s:Hand");
  ExpectRefused("take.csv", vicon, map, "time_unit: frame needs rate_hz");
  ExpectCarried("take.csv", vicon, map + "rate_hz: 60\n");
}

TEST(ImportLayouts, AMapThatContradictsAHeadIsRefused) {
  const auto refused = [](const std::string& file, const std::string& bytes, const std::string& map,
                          const std::string& key) {
    ExpectRefused(file, bytes, map + key, "'" + key.substr(0, key.find(':')) + "' contradicts the");
  };
  const std::string y_up = "axes: y_up\n" + Entities(), z_up = "axes: z_up\n" + Entities();
  refused("take.csv", MotiveCsv({}), y_up, "time_unit: ms\n");
  refused("take.csv", MotiveCsv({}), y_up, "separator: tab\n");
  refused("take.trc", Trc("Cup\t\t\tHand\t\t", "mm", 1000, "\n"), y_up, "time_unit: us\n");
  refused("take.tsv", QualisysTsv({}), z_up, "time_unit: ns\n");
  refused("take.tsv", QualisysTsv({}), z_up, "separator: comma\n");
  refused("take.csv", ViconCsv("Objects", "Helical"), "axes: z_up\n" + Entities("s:Cup", "s:Hand"),
          "time_unit: s\n");
  for (const char* key : {"separator: comma", "decimal: point", "header_line: 1"})
    ExpectRefused("take.json", "[]", "axes: z_up\nunit: m\n" + Entities() + key + "\n",
                  "is that of CSV files; this is none");
  // TUM has no head, and EuRoC's says its units in brackets.
  const auto rows = [](double per_m, double per_s, const std::string& separator) {
    return Rows([&](int i) {
      return std::to_string(std::llround(per_s * 1305031102 + i / kRate_hz * per_s)) + separator +
             Three(CupAt(i / kRate_hz), per_m, separator) + separator +
             (separator == "," ? "1,0,0,0" : "0 0 0 1");
    });
  };
  ExpectCup("take.txt", rows(1, 1e9, " "), "time_unit: ns\n");
  ExpectCup("take.txt", rows(1000, 1e6, " "), "time_unit: us\nunit: mm\n");
  const std::string head =
      "#timestamp [us],p_x [mm],p_y [mm],p_z [mm],q_w [],q_x [],q_y [],q_z []\n";
  for (const char* key : {"", "unit: mm\n", "time_unit: us\n"})
    ExpectCup("take.csv", head + rows(1000, 1e6, ","), key);
  ExpectCup("take.csv", head + rows(1000, 1e6, ","), "unit: m\n", "'unit' contradicts the file");
  ExpectCup("take.csv", head + rows(1000, 1e6, ","), "time_unit: ns\n",
            "'time_unit' contradicts the file");
  ExpectCup("take.csv", "#timestamp,p_x,p_y,p_z,q_w,q_x,q_y,q_z\n" + rows(1000, 1e6, ","),
            "time_unit: us\nunit: mm\n");
}

TEST(ImportLayouts, AFileThatIsNotThereOrEmptyIsNamed) {
  const auto folder = FreshFolder("layouts");
  WriteFile(folder / "map.yaml", "import: 1\n" + kMotiveMap);
  WriteFile(folder / "empty.csv", "");
  for (const auto& [file, why] : {std::pair("none.csv", "none.csv: error: no such file"),
                                  {"empty.csv", "empty.csv: error: the file is empty"}}) {
    const Said said =
        Prehend({"import", (folder / file).string(), "--map", (folder / "map.yaml").string(), "-o",
                 (folder / "x.jsonl").string()});
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_NE(said.err.find(why), std::string::npos) << said.err;
    EXPECT_EQ(said.err.find("map.yaml:"), std::string::npos) << said.err;
  }
}

/// The map of docs/motion-capture.md that has this text.
std::string MapOfDocs(const std::string& text) {
  const std::string page = ReadFile(PREHEND_SOURCE_DIR "/docs/motion-capture.md");
  for (std::size_t at = 0; (at = page.find("```yaml\n", at)) != std::string::npos; ++at) {
    const std::string map = page.substr(at + 8, page.find("```\n", at + 8) - at - 8);
    if (map.find(text) != std::string::npos) return map;
  }
  return "";
}

TEST(ImportLayouts, TheMapsOfTheDocsAreWholeMaps) {
  const auto folder = FreshFolder("layouts");
  const auto check = [&](const std::string& file, const std::string& bytes,
                         const std::string& map) {
    const Said said = ImportFile(folder, file, bytes, map, {"--check"});
    EXPECT_EQ(said.exit_code, 0) << map << said.err;
    EXPECT_NE(said.out.find("0.00..0.40"), std::string::npos) << said.out;
  };
  const std::string motive = MapOfDocs("from: Hand, hand");
  check("take.csv", MotiveCsv({}), motive);
  check("take.tsv", QualisysTsv({.six = true}), Replaced(motive, "y_up", "z_up"));
  check("cup.txt", Rows([](int i) {
          const Row r = CupAt(i / kRate_hz);
          return "1 0 0 " + Text(r.x) + " 0 1 0 " + Text(-r.z) + " 0 0 1 " + Text(r.y);
        }),
        MapOfDocs("up: [0, -1, 0]"));
  std::string csv = "hand,landmark,x,y,z,rx,ry,rz\n";
  for (int i = 0; i < kFrames; ++i)
    csv += "Left,8," + Three(CupAt(i / kRate_hz), 1, ",") + ",0,0,30\n";
  check("take.csv", csv, MapOfDocs("[hand, landmark]"));
}

TEST(ImportLayouts, OtherFilesAreNamed) {
  for (const char* ending : {".xlsx", ".parquet", ".npy", ".pkl", ".zip", ".XLSX"}) {
    std::string small = ending;
    for (char& c : small) c = static_cast<char>(std::tolower(c));
    ExpectRefused(std::string("take") + ending, "{}", kMotiveMap,
                  "files " + small + " are not read");
  }
}

TEST(ImportLayouts, AThingThatNeverMovesIsNoWrongUnit) {
  const Take take =
      Import("poses.csv", "t,x,y,z\n0,0.1,0.2,0.8\n0.02,0.1,0.2,0.8\n0.04,0.1,0.2,0.8\n",
             "unit: m\naxes: z_up\ntime_unit: s\n"
             "columns: {time: t, position: [x, 'y', z]}\n"
             "entities:\n  cup: {from: poses, size_m: [0.1, 0.1, 0.1]}\n");
  EXPECT_EQ(take.said.exit_code, 0) << take.said.err;
  EXPECT_NE(take.said.err.find("nothing moves: each body stays within 1 mm"), std::string::npos);
  EXPECT_EQ(take.said.err.find("unit"), std::string::npos) << take.said.err;
}

TEST(ImportLayouts, OrdersOfAnglesAreChecked) {
  const std::string csv = "t,rx,ry,rz,x,y,z\n0,1,2,3,0,0,0\n1,1,2,3,0,0,0\n",
                    map =
                        "unit: m\naxes: z_up\ntime_unit: s\nangle_unit: deg\n"
                        "columns: {time: t, position: [x, 'y', z], euler: [rx, ry, rz]}\n"
                        "entities:\n  cup: {from: poses, size_m: [0.1, 0.1, 0.1]}\n";
  ExpectRefused("poses.csv", csv, map, "euler_order is missing");
  ExpectRefused("poses.csv", csv, map + "euler_order: ZYX\n", "the columns are in the order xyz");
  ExpectRefused("poses.csv", csv, map + "euler_order: abc\n", "expected three axes like XYZ");
  ExpectRefused("poses.csv", csv, map + "euler_order: XYZ\nquaternion_order: wxyz\n",
                "'quaternion_order' says nothing here: the file has angles");
}

}  // namespace
}  // namespace prehend::house

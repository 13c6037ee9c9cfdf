// SPDX-License-Identifier: Apache-2.0
// Signs that the map says something wrong of a recording of a person or a robot: angles, times,
// grippers, sizes, and times that the file does not have. Each is silent where the map is right.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/program/carried_cup.h"
#include "tests/program/import_csv.h"

namespace prehend::house {
namespace {

class ImportSigns : public testing::Test {
 protected:
  /// What import says of the carried cup at 60 Hz; `turn`: the cells of a body's orientation.
  Said Carried(const std::function<std::string(bool is_cup, double t_s)>& turn,
               const std::string& columns, const std::string& map = "", double times = 1) const {
    std::string csv = "t,name,x,y,z,a,b,c,d\n";
    for (int i = 0; i <= 300; ++i) {
      for (const bool is_cup : {true, false}) {
        const Row at = is_cup ? CupAt(i / 60.0) : HandAt(i / 60.0);
        char text[100];
        std::snprintf(text, sizeof text, "%.5f,%s,%.5f,%.5f,%.5f,", i / 60.0 * times,
                      is_cup ? "Mug" : "Glove", at.x, at.y, at.z);
        csv += text + turn(is_cup, i / 60.0) + "\n";
      }
    }
    std::string text = kCupMap;
    text = Replaced(text, "quaternion_order: wxyz\n", map);
    return ImportCsv(folder_, csv, Replaced(text, "quaternion: [qw, qx, qy, qz]", columns));
  }

  /// Tips the cup by 110 degrees in the air, in a unit that is so many degrees, as `columns`.
  std::string Tipped(const std::string& unit, double degrees, const std::string& columns) const {
    const auto turn = [&](bool, double t_s) {
      const double tip = Along({{2, 0}, {2.4, 110}, {2.6, 110}, {3, 0}}, t_s) / degrees;
      return std::to_string(tip) + ",0,0,0";
    };
    const bool is_euler = columns.starts_with("euler");
    const Said said = Carried(turn, columns, (is_euler ? "euler_order: XYZ\n" : "") + unit);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.err;
  }

  const std::filesystem::path folder_ = FreshFolder("import_signs");
};

constexpr double kRadian_deg = 57.29577951308232;

TEST_F(ImportSigns, AnglesInTheOtherUnit) {
  for (const char* columns : {"euler: [a, b, c]", "axis_angle: [a, b, c]"}) {
    EXPECT_EQ(Tipped("angle_unit: deg\n", 1, columns), "");
    EXPECT_EQ(Tipped("angle_unit: rad\n", kRadian_deg, columns), "");
    EXPECT_EQ(Tipped("angle_unit: rad\n", 1, columns),
              "warning: angles of up to 110 are read as radians: they look like degrees: "
              "angle_unit: deg; or, if it is right, sure: [angle_unit]\n");
    EXPECT_EQ(Tipped("angle_unit: deg\n", kRadian_deg, columns),
              "warning: angles of up to 1.92 are read as degrees, and nothing turns by more than "
              "1.9 degrees; in radians that is 110: angle_unit: rad; or, if it is right, sure: "
              "[angle_unit]\n");
    EXPECT_EQ(Tipped("angle_unit: rad\nsure: [angle_unit]\n", 1, columns), "");
  }
}

std::string Upright(bool, double) { return "1,0,0,0"; }

TEST_F(ImportSigns, HandsThatAreTooFastAreNamedAlone) {
  const std::string columns = "quaternion: [a, b, c, d]", order = "quaternion_order: wxyz\n";
  EXPECT_EQ(Carried(Upright, columns, order).err, "");
  // It reaches and leaves with 0.745 m/s, five and twenty times that.
  EXPECT_EQ(Carried(Upright, columns, order, 0.2).err.find("the hands go"), std::string::npos);
  const Said fast = Carried(Upright, columns, order, 0.05);
  EXPECT_EQ(fast.exit_code, 0) << fast.err;
  EXPECT_NE(fast.err.find("warning: the hands go 0.828 m far, at up to 14.9 m/s: correct unit, or "
                          "what the map says of times; or, if it is right, sure: [unit]\n"),
            std::string::npos)
      << fast.err;
  EXPECT_EQ(Carried(Upright, columns, order + "sure: [unit]\n", 0.05).err.find("the hands go"),
            std::string::npos);
}

TEST_F(ImportSigns, AnOutlierOfAHandIsNoSpeed) {
  std::string csv = "t,name,x,y,z,qw,qx,qy,qz\n";
  for (int i = 0; i <= 300; ++i) {
    const double t_s = i / 100.0,
                 away = i >= 168 && i < 171 ? 0.4 : Along({{1, 0}, {1.2, 0.05}}, t_s);
    csv += AsWritten("Mug", {t_s, 0, 0, 0.77}) + AsWritten("Glove", {t_s, away, 0, 1.65});
  }
  const Said said = ImportCsv(folder_, csv, std::string(kCupMap) + "outlier: lost\n");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.err.find("goes out and back 1 time"), std::string::npos) << said.err;
  EXPECT_EQ(said.err.find("the hands go"), std::string::npos) << said.err;
}

TEST_F(ImportSigns, ATimeAtWhichNothingStandsUprightIsNamed) {
  const std::string columns = "quaternion: [a, b, c, d]", order = "quaternion_order: wxyz\n";
  ASSERT_EQ(Carried(Upright, columns, order).exit_code, 0);
  const std::string csv = ReadFile(folder_ / "poses.csv"), map = ReadFile(folder_ / "map.yaml");
  const auto upright_at = [&](const std::string& csv_text, const std::string& t_s) {
    return ImportCsv(
        folder_, csv_text,
        Replaced(map, "class: Cup", "class: Cup, upright_at_s: " + t_s) + "lost: unknown\n");
  };
  EXPECT_EQ(upright_at(csv, "4.9").err, "");
  const Said late = upright_at(csv, "60");
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_NE(late.err.find("map.yaml:14:46: error: the file ends at 5.000 s\n"), std::string::npos)
      << late.err;
  std::string gap;  // of the cup, from 1.5 to 2.5 s
  std::size_t at = 0;
  for (std::size_t next = csv.find('\n') + 1; at < csv.size(); at = next) {
    next = csv.find('\n', at) + 1;
    const double t_s = std::atof(csv.c_str() + at);
    if (csv.compare(at, next - at, "t") > 0 || t_s < 1.5 || t_s > 2.5 ||
        csv.substr(at, next - at).find("Mug") == std::string::npos)
      gap += csv.substr(at, next - at);
  }
  EXPECT_NE(upright_at(gap, "1.8")
                .err.find("warning: 'Mug' is not tracked at its upright_at_s, "
                          "1.8 s: its pose at 1.483 s counts\n"),
            std::string::npos);
}

TEST_F(ImportSigns, ATableAFewCentimetresOffSupportsAsTheGrammarSays) {
  const std::string columns = "quaternion: [a, b, c, d]", order = "quaternion_order: wxyz\n";
  ASSERT_EQ(Carried(Upright, columns, order).exit_code, 0);
  const std::string csv = ReadFile(folder_ / "poses.csv"), map = ReadFile(folder_ / "map.yaml");
  const Said low =
      ImportCsv(folder_, csv, Replaced(map, "at_m: [0, 0, 0.7]", "at_m: [0, 0, 0.64]"));
  EXPECT_EQ(low.err,
            "warning: 'cup' rests 60 mm above 'table': is at_m or size_m of 'table', or offset_m "
            "or size_m of 'cup' wrong?\n");
  EXPECT_NE(
      Prehend({"episode", "resegment", (folder_ / "take.jsonl").string()}).out.find("putting_down"),
      std::string::npos);
}

TEST_F(ImportSigns, SizesInMillimetres) {
  const std::string columns = "quaternion: [a, b, c, d]", order = "quaternion_order: wxyz\n";
  ASSERT_EQ(Carried(Upright, columns, order).exit_code, 0);
  const std::string csv = ReadFile(folder_ / "poses.csv"), map = ReadFile(folder_ / "map.yaml");
  for (const auto& [size, of] :
       {std::pair{"[80, 80, 100]", "millimetres"}, std::pair{"[8, 8, 10]", "centimetres"}}) {
    const Said said = ImportCsv(folder_, csv, Replaced(map, "[0.08, 0.08, 0.1]", size));
    EXPECT_NE(said.err.find(std::string("if these are ") + of + ": size_m: [0.08, 0.08, 0.1]\n"),
              std::string::npos)
        << said.err;
  }
}

TEST_F(ImportSigns, NumbersThatStandForNoPoseAreNamedAsWhatTheyAre) {
  const std::string columns = "quaternion: [a, b, c, d]", order = "quaternion_order: wxyz\n";
  ASSERT_EQ(Carried(Upright, columns, order).exit_code, 0);
  const std::string csv = ReadFile(folder_ / "poses.csv"), map = ReadFile(folder_ / "map.yaml");
  const std::size_t at = csv.find("Mug,", csv.size() / 2);
  for (const auto& [cells, hint] :
       {std::pair{"-1.0,-1.0,-1.0,-1.0,-1.0,-1.0,-1.0",
                  "if this means 'not tracked', in the map: missing: [-1.0]"},
        std::pair{"0,0,0,0,0,0,0",
                  "if this means 'not tracked', in the map: zero_is_missing: true"},
        std::pair{"0.1,0.2,0.3,4,4,4,4",
                  "are these the four columns of one body's orientation?"}}) {
    std::string lost = csv;
    lost.replace(at + 4, lost.find('\n', at) - at - 4, cells);
    const Said said = ImportCsv(folder_, lost, map);
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_NE(said.err.find(std::string("hint: ") + hint + "\n"), std::string::npos) << said.err;
  }
}

/// A gripper that points down, with the fingers' width in `d`, carries the cup.
class ImportGripperSigns : public ImportSigns {
 protected:
  std::string Said_(const std::string& order, const std::string& grip) const {
    std::string csv =
        "t,cup_x,cup_y,cup_z,cup_a,cup_b,cup_c,cup_d,eef_x,eef_y,eef_z,eef_a,eef_b,"
        "eef_c,eef_d,width\n";
    for (int i = 0; i <= 100; ++i) {
      const double t_s = i / 20.0;
      const Row cup = CupAt(t_s), hand = HandAt(t_s);
      char text[250];
      std::snprintf(text, sizeof text, "%.3f,%.5f,%.5f,%.5f,0,0,0,1,%.5f,%.5f,%.5f,1,0,0,0,%.5f\n",
                    t_s, cup.x, cup.y, cup.z, hand.x + 0.08, hand.y, hand.z,
                    Along({{0.9, 0.08}, {1.2, 0.043}, {3.5, 0.043}, {3.7, 0.08}}, t_s));
      csv += text;
    }
    const Said said = ImportCsv(
        folder_, csv,
        "import: 1\nunit: m\naxes: z_up\ntime_unit: s\nquaternion_order: " + order +
            "\ncolumns: {time: t, position: ['{}_x', '{}_y', '{}_z'], quaternion: ['{}_a', '{}_b', "
            "'{}_c', '{}_d']}\nentities:\n  table: {at_m: [0, 0, 0.7], fixed: true, class: Table, "
            "size_m: [2.0, 1.0, 0.04]}\n  cup: {from: cup, class: Cup, size_m: [0.08, 0.08, 0.1]}\n"
            "  hand: {from: eef, hand: true, size_m: [0, 0, 0], grip: {from: [width], " +
            grip + "}}\n");
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return said.err;
  }
};

TEST_F(ImportGripperSigns, ARightMapOfAGripperThatPointsDownIsNotDoubted) {
  EXPECT_EQ(Said_("xyzw", "open: 0.08, closed: 0"), "");
}

TEST_F(ImportGripperSigns, TheOtherOrderIsDoubtedByWhatItCarries) {
  EXPECT_EQ(Said_("wxyz", "open: 0.08, closed: 0"),
            "warning: the first of four numbers, as w, is 0.00 (median, without its sign), the "
            "last is 1.00: this looks like xyzw: quaternion_order: xyzw; or, if it is right, sure: "
            "[quaternion_order]\n");
}

TEST_F(ImportGripperSigns, OpenAndClosedAreExchanged) {
  EXPECT_EQ(Said_("xyzw", "open: 0, closed: 0.08"),
            "warning: the gripper 'eef' is never wider open than while it carries things: are open "
            "and closed exchanged? (open: 0.08, closed: 0); or, if not, sure: [place]\n");
}

}  // namespace
}  // namespace prehend::house

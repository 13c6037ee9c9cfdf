// SPDX-License-Identifier: Apache-2.0
// What goes from hand to hand, and what two hands hold: of simulated touches, and of the poses of
// the same runs alone. Drawings of more cases are in tests/grammar/corpus/library.txt.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/program/import_csv.h"

namespace prehend::house {
namespace {

using Spans =
    std::map<std::string, std::pair<double, double>>;  ///< of hand-overs and shared holds, s

Spans In(const Said& said) {
  EXPECT_EQ(said.exit_code, 0) << said.err;
  const auto json = nlohmann::ordered_json::parse(said.out);
  const double rate = json["ticks_per_second"].get<double>();
  Spans spans;
  for (const auto& event : json["events"]) {
    std::string text = event["event"].get<std::string>();
    if (text != "handing_over" && text != "held_by_both") continue;
    for (const auto& role : event["roles"]) text += " " + role.get<std::string>();
    EXPECT_TRUE(spans
                    .emplace(text, std::pair(event["begin_tick"].get<double>() / rate,
                                             event["end_tick"].get<double>() / rate))
                    .second)
        << text;
  }
  return spans;
}

void ExpectSpan(const Spans& spans, const std::string& what, double begin_s, double end_s,
                double within_s) {
  ASSERT_TRUE(spans.contains(what)) << what;
  EXPECT_NEAR(spans.at(what).first, begin_s, within_s) << what;
  EXPECT_NEAR(spans.at(what).second, end_s, within_s) << what;
}

/// The scenario with each grammar.
std::pair<Spans, Spans> Of(const std::string& scenario) {
  const std::string file = (FreshFolder("handing_over") / "run.jsonl").string();
  EXPECT_EQ(Prehend({"run", scenario, "--record", file}).exit_code, 0);
  return {In(Prehend({"episode", "resegment", file, "--json", "--grammar", "handing_over"})),
          In(Prehend(
              {"episode", "resegment", file, "--json", "--grammar", "handing_over_from_motion"}))};
}

// The left hand grasps at 2.95 s and has been at the box, waiting, since 2.6 s; the right one opens
// at 3.3 s and leaves.
TEST(HandingOver, InTheAir) {
  const auto [touches, motion] = Of("hand_over_in_the_air");
  EXPECT_EQ(touches.size(), 2u);
  ExpectSpan(touches, "handing_over right_hand left_hand box", 2.95, 3.31, 0.02);
  ExpectSpan(touches, "held_by_both left_hand right_hand box", 2.95, 3.31, 0.02);
  EXPECT_EQ(motion.size(), 2u);
  ExpectSpan(motion, "handing_over right_hand left_hand box", 2.95, 3.31, 0.4);
}

// Both let go at once, at 4.2 s: nobody has taken it.
TEST(HandingOver, AHandThatJoinsTakesNothing) {
  const auto [touches, motion] = Of("second_hand_joins_a_carry");
  EXPECT_EQ(touches.size(), 1u);
  ExpectSpan(touches, "held_by_both left_hand right_hand box", 2.95, 4.22, 0.02);
  EXPECT_EQ(motion.size(), 1u);
  EXPECT_TRUE(motion.contains("held_by_both left_hand right_hand box"));
}

// On the table, poses do not tell when the second hand holds it: it is moved by neither, and would
// lie there anyway.
TEST(HandingOver, OnATableOnlyTouchesTell) {
  const auto [touches, motion] = Of("taken_from_the_other_hand_on_the_table");
  ExpectSpan(touches, "handing_over left_hand right_hand box", 2.68, 2.82, 0.02);
  EXPECT_TRUE(motion.empty());
}

double Smooth(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// A made take: the right hand lifts the cup at 1 s and holds it out at 2 s; the left one comes to
/// it from 2.2 to 3 s, `stays` at it or takes it along, and the right one leaves, with the cup or
/// without it, from 3.5 s on.
Spans Made(bool left_takes, bool right_takes) {
  std::string csv = "t,cup_x,cup_y,cup_z,right_x,right_y,right_z,left_x,left_y,left_z\n";
  char row[200];
  for (int i = 0; i <= 600; ++i) {
    const double t = i / 100.0, lift = 0.3 * Smooth(t, 1, 2), away = 0.4 * Smooth(t, 3.5, 4.3);
    const double cup = (left_takes ? -0.4 * Smooth(t, 4.5, 5.3) : 0) + (right_takes ? away : 0);
    const double right = 0.06 + 0.4 * (1 - Smooth(t, 0.1, 0.8)) + away;
    const double left = -0.06 - 0.5 * (1 - Smooth(t, 2.2, 3)) + (left_takes ? cup : 0);
    std::snprintf(row, sizeof row, "%.2f,%.5f,0,%.5f,%.5f,0,%.5f,%.5f,0,%.5f\n", t, cup,
                  0.77 + lift, right, 0.77 + lift, left, 0.77 + lift);
    csv += row;
  }
  const auto folder = FreshFolder("handing_over");
  const Said said = ImportCsv(
      folder, csv,
      "import: 1\nunit: m\naxes: z_up\ntime_unit: s\ncolumns: {time: t, position: "
      "[\"{}_x\", \"{}_y\", \"{}_z\"]}\nentities:\n  table: {at_m: [0, 0, 0.7], fixed: true, "
      "class: Table, size_m: [2, 1, 0.04]}\n  cup: {from: cup, class: Cup, size_m: [0.08, 0.08, "
      "0.1]}\n  right: {from: right, hand: true, size_m: [0, 0, 0]}\n  left: {from: left, hand: "
      "true, size_m: [0, 0, 0]}\n");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  return In(Prehend({"episode", "resegment", (folder / "take.jsonl").string(), "--json",
                     "--grammar", "handing_over_from_motion"}));
}

TEST(HandingOver, OfPosesAlone) {
  const Spans given = Made(true, false);
  EXPECT_EQ(given.size(), 2u);
  ExpectSpan(given, "handing_over right left cup", 2.95, 3.65, 0.15);
  ExpectSpan(given, "held_by_both left right cup", 2.95, 3.65, 0.15);
  // It is offered and taken back: the left hand stays where it was.
  EXPECT_FALSE(Made(false, true).contains("handing_over right left cup"));
}

}  // namespace
}  // namespace prehend::house

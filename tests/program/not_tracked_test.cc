// SPDX-License-Identifier: Apache-2.0
// A look that is missing is a value of recordings: null. For a stated time the last one counts,
// then nobody knows.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

/// Two seconds in frames of 20 ms. The cup, 1 cm from the hand, is not tracked from `lost` to
/// `found`, frames.
std::string Recording(int lost, int found, const std::string& header = "") {
  std::string text =
      "{\"recording\": 1, \"episode\": \"e\", \"ticks_per_second\": 1000, " + header +
      "\"entities\": {\"cup\": {\"class\": \"Cup\", \"size_m\": [0.1, 0.1, 0.1]}, \"hand\": "
      "{\"hand\": true, \"size_m\": [0, 0, 0]}}}\n";
  for (int i = 0; i < 100; ++i) {
    char line[300];
    const std::string cup =
        i >= lost && i < found ? "null" : "{\"at_m\": [" + std::to_string(0.001 * i) + ", 0, 0.8]}";
    std::snprintf(
        line, sizeof line,
        "{\"tick\": %d, \"samples\": {\"cup\": %s, \"hand\": {\"at_m\": [%g, 0, 0.81]}}}\n", 20 * i,
        cup.c_str(), 0.001 * i);
    text += line;
  }
  return text + "{\"end_tick\": 2000}\n";
}

class NotTracked : public testing::Test {
 protected:
  NotTracked() {
    WriteFile(folder_ / "g.grammar",
              "grammar g\nevent near(hand: Hand, cup: Cup) while distance(hand, cup) < 5 cm\n"
              "event moving(cup: Cup) while speed(cup) > 1 cm/s\n"
              "event far(hand: Hand, cup: Cup) while not (distance(hand, cup) < 4 cm)\n");
  }
  Said Segment(const std::string& recording,
               std::vector<std::string> words = {"episode", "resegment"}) const {
    WriteFile(folder_ / "take.jsonl", recording);
    words.insert(words.end(), {(folder_ / "take.jsonl").string(), "--grammar",
                               (folder_ / "g.grammar").string()});
    return Prehend(words);
  }
  const std::filesystem::path folder_ = FreshFolder("not_tracked");
};

TEST_F(NotTracked, AShortGapIsBridgedAndTheReportSaysSo) {
  const Said whole = Segment(Recording(0, 0)), gap = Segment(Recording(40, 44));
  EXPECT_EQ(gap.exit_code, 0) << gap.err;
  EXPECT_EQ(gap.out, whole.out);
  EXPECT_EQ(whole.err, "");
  EXPECT_EQ(
      gap.err,
      "warning: 'cup' is not tracked in 1 gap: 0.080 s are bridged, in 0.000 s it is unknown\n");
}

// Its gripper may still say its width: the hand is where it was seen last, and stands still there.
TEST_F(NotTracked, AHandWhoseGripIsKnownStaysWhereItWas) {
  WriteFile(folder_ / "g.grammar",
            "grammar g\nevent near(hand: Hand, cup: Cup) while gap(hand, cup) < 20 cm\n"
            "event moving(hand: Hand) while surface_speed(hand) > 10 cm/s\n");
  const auto recording = [](const std::string& hands) {
    std::string text =
        "{\"recording\": 1, \"episode\": \"e\", \"ticks_per_second\": 100, \"entities\": {\"cup\": "
        "{\"class\": \"Cup\", \"size_m\": [0.1, 0.1, 0.1]}, \"hand\": {\"hand\": true, \"size_m\": "
        "[0, 0, 0]}}}\n";
    for (int i = 0; i < 60; ++i)
      text += "{\"tick\": " + std::to_string(i) +
              ", \"samples\": {\"cup\": {\"at_m\": [1, 0, 0.8]}, \"hand\": " +
              (i >= 20 && i < 23 ? "null}" + hands : "{\"at_m\": [0.9, 0, 0.8]}}") + "}\n";
    return text + "{\"end_tick\": 60}\n";
  };
  const Said without = Segment(recording("")),
             with = Segment(recording(", \"hands\": {\"hand\": {\"trigger\": 0.5}}"));
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_EQ(with.out, without.out);
  EXPECT_NE(with.out.find("near   0.0000   0.6000"), std::string::npos) << with.out;
  EXPECT_EQ(with.out.find("moving"), std::string::npos) << with.out;
}

// What touches and is lost for a moment touches as it did, also where its speed is computed.
TEST_F(NotTracked, ASpeedOfATouchIsBridged) {
  WriteFile(folder_ / "g.grammar",
            "grammar g\nevent slow(hand: Hand, cup: Cup)\n  while touching(hand, cup) and "
            "touch_speed(hand, cup) < 5 cm/s\n");
  std::string touching = Recording(40, 44);
  for (std::size_t at = 0; (at = touching.find("0.81]}}}", at)) != std::string::npos; ++at)
    touching.replace(at, 8, "0.81]}}, \"touches\": [{\"a\": \"hand\", \"b\": \"cup\"}]}");
  const Said said = Segment(touching);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("slow   0.0000   2.0000"), std::string::npos) << said.out;
}

// Of a hand that is lost for 2 s, from 1.0 s on, nobody knows whether it idles; for 0.5 s it does
// what it did. Looks are bridged for 0.1 s.
TEST_F(NotTracked, AHandThatIsLostForLongDoesNotIdle) {
  const auto idling = [&](int lost, int found) {
    std::string text =
        "{\"recording\": 1, \"episode\": \"e\", \"ticks_per_second\": 1000, \"entities\": "
        "{\"cup\": "
        "{\"size_m\": [0.1, 0.1, 0.1]}, \"hand\": {\"hand\": true, \"size_m\": [0, 0, 0]}}}\n";
    for (int i = 0; i < 200; ++i) {
      text += "{\"tick\": " + std::to_string(20 * i) +
              ", \"samples\": {\"cup\": {\"at_m\": [0, 0, 0.8]}, \"hand\": " +
              (i >= lost && i < found ? "null" : "{\"at_m\": [1, 0, 1]}") + "}}\n";
    }
    WriteFile(folder_ / "take.jsonl", text + "{\"end_tick\": 4000}\n");
    return Prehend({"episode", "resegment", (folder_ / "take.jsonl").string(), "--grammar",
                    "hand_actions_from_motion"})
        .out;
  };
  const std::string lost = idling(50, 150);
  EXPECT_NE(lost.find("idling  0.0000   1.1000  hand=hand"), std::string::npos) << lost;
  EXPECT_NE(lost.find("idling  3.0000   4.0000  hand=hand"), std::string::npos) << lost;
  const std::string briefly = idling(50, 75);
  EXPECT_NE(briefly.find("idling  0.0000   4.0000  hand=hand"), std::string::npos) << briefly;
}

TEST_F(NotTracked, WhatALongGapLeavesUnknownEndsAndNeitherDoesItsOppositeHold) {
  const Said said = Segment(Recording(40, 60));
  EXPECT_EQ(said.exit_code, 0) << said.err;
  // Seen last at 0.780 s; frames up to 0.880 s are bridged, the cup is found again at 1.200 s.
  EXPECT_EQ(said.out,
            "event   begin_s  end_s   roles\n"
            "near    0.0000   0.9000  hand=hand  cup=cup\n"
            "moving  0.0200   0.9000  cup=cup\n"
            "near    1.2000   2.0000  hand=hand  cup=cup  open_end\n"
            "moving  1.2200   2.0000  cup=cup             open_end\n"
            "completed: 2.0000 s, 2000 ticks\n");
  EXPECT_EQ(
      said.err,
      "warning: 'cup' is not tracked in 1 gap: 0.100 s are bridged, in 0.300 s it is unknown\n"
      "assumed: in near(hand, cup), 0.0000..0.9000 s, 'cup' is not seen for 0.100 s\n"
      "assumed: in moving(cup), 0.0200..0.9000 s, 'cup' is not seen for 0.100 s\n");
  // No frame is in the first 0.3 s of that: they are bridged by nobody.
  std::string late = Recording(40, 60);
  late.erase(late.find("{\"tick\": 800,"),
             late.find("{\"tick\": 1100,") - late.find("{\"tick\": 800,"));
  EXPECT_EQ(
      Segment(late).err,
      "warning: 'cup' is not tracked in 1 gap: 0.000 s are bridged, in 0.100 s it is unknown\n");
  const Said longer = Segment(Recording(40, 60, "\"bridge_s\": 0.5, "));
  EXPECT_EQ(longer.out, Segment(Recording(0, 0)).out);
  const Said never = Segment(Recording(40, 44, "\"bridge_s\": 0, "));
  EXPECT_NE(never.out.find("near    0.0000   0.8000"), std::string::npos) << never.out;
}

// What the last frame says holds to the end.
TEST_F(NotTracked, TheTimeAfterTheLastFrameCounts) {
  for (const auto& [bridge_s, said] :
       {std::pair("0", "0.000 s are bridged, in 10.000 s it is unknown"),
        std::pair("0.5", "10.000 s are bridged, in 0.000 s it is unknown")}) {
    const std::string text =
        std::string(
            "{\"recording\": 1, \"episode\": \"e\", \"ticks_per_second\": 100, "
            "\"bridge_s\": ") +
        bridge_s +
        ", \"entities\": {\"cup\": {\"class\": \"Cup\", \"size_m\": [0.1, 0.1, 0.1]}, \"hand\": "
        "{\"hand\": true, \"size_m\": [0, 0, 0]}}}\n"
        "{\"tick\": 0, \"samples\": {\"cup\": {\"at_m\": [0, 0, 0]}, \"hand\": {\"at_m\": [0, 0, "
        "0]}}}\n"
        "{\"tick\": 10, \"samples\": {\"cup\": null}}\n{\"end_tick\": 1010}\n";
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"episode", "resegment"}, {"grammar", "watch"}}) {
      const Said of = Segment(text, words);
      EXPECT_NE(of.err.find(std::string("'cup' is not tracked in 1 gap: ") + said),
                std::string::npos)
          << of.err;
    }
  }
}

TEST_F(NotTracked, WatchSaysTheSame) {
  const Said said = Segment(Recording(40, 60), {"grammar", "watch"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("0.9000  near  0.0000  0.9000"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("2.0000  near  1.2000  2.0000"), std::string::npos) << said.out;
  EXPECT_NE(said.err.find("0.100 s are bridged, in 0.300 s it is unknown"), std::string::npos)
      << said.err;
}

TEST_F(NotTracked, WhatIsNeverSeenIsToldAndTakesPartInNothing) {
  const Said said = Segment(Recording(0, 100));
  EXPECT_NE(said.err.find("warning: no frame says where 'cup' is, so no condition on its pose ever "
                          "holds\n"),
            std::string::npos)
      << said.err;
  EXPECT_EQ(said.out.find("near"), std::string::npos) << said.out;
  EXPECT_EQ(said.out.find("far"), std::string::npos) << said.out;
}

TEST_F(NotTracked, WhatIsSeenLaterHasThePoseOfItsFirstSample) {
  // The samples have no orientation; it is not turned.
  WriteFile(folder_ / "g.grammar",
            "grammar g\nevent so(cup: Cup) while tilt(cup) < 0.1 rad and speed(cup) < 1 m/s\n");
  for (const int found : {0, 30}) {
    const Said said = Segment(Recording(0, found));
    EXPECT_NE(said.out.find(found == 0 ? "so     0.0000   2.0000" : "so     0.6000   2.0000"),
              std::string::npos)
        << said.out;
  }
}

TEST_F(NotTracked, ExplainAndTracksSayIt) {
  WriteFile(folder_ / "take.jsonl", Recording(40, 60));
  const Said tracks = Prehend({"grammar", "tracks", (folder_ / "take.jsonl").string(), "--grammar",
                               (folder_ / "g.grammar").string()});
  EXPECT_EQ(tracks.exit_code, 0) << tracks.err;
  EXPECT_EQ(tracks.out.find("nan"), std::string::npos) << tracks.out;
  const Said explain = Prehend({"explain", (folder_ / "take.jsonl").string(), "--grammar",
                                (folder_ / "g.grammar").string(), "--event", "near"});
  EXPECT_EQ(explain.exit_code, 0) << explain.err;
  EXPECT_EQ(explain.out.find("nan"), std::string::npos) << explain.out;
}

}  // namespace
}  // namespace prehend::house

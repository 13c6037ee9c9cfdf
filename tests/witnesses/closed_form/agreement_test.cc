// SPDX-License-Identifier: Apache-2.0
#include "tests/witnesses/closed_form/agreement.h"

#include <gtest/gtest.h>

namespace prehend::witnesses {
namespace {

/// 48 frames per second, at ticks 10, 20, .. 100 of a world at 480 Hz, without the one at 50.
ClosedFormRecording Recording() {
  ClosedFormRecording recording;
  recording.scenario.scene.world.rate_hz = 480;
  recording.scenario.sensing.sensing_hz = 48;
  for (const grammar::Tick tick : {10, 20, 30, 40, 60, 70, 80, 90, 100})
    recording.frames.push_back({.tick = tick});
  recording.end = 101;
  return recording;
}

grammar::Timeline Recognised(grammar::Tick begin, grammar::Tick end) {
  return {480,
          {{"reaching", {{"hand", "hand"}, {"object", "cup"}}, {begin, end}},
           {"sliding", {{"hand", "hand"}, {"object", "cup"}}, {70, 80}}}};
}

std::vector<JudgedEvent> Judged(double begin_tick, grammar::Tick begin) {
  return ClosedFormAgreement({{"reaching(hand, cup)", begin_tick / 480, 90.0 / 480},
                              {"sliding(hand, cup)", 70.0 / 480, 80.0 / 480}},
                             Recording(), Recognised(begin, 90));
}

TEST(ClosedFormAgreement, AllowsTheFramesOnBothSidesOfAMoment) {
  EXPECT_FALSE(Judged(25, 10)[0].begin.right);
  EXPECT_TRUE(Judged(25, 20)[0].begin.right);
  EXPECT_TRUE(Judged(25, 30)[0].begin.right);
  EXPECT_FALSE(Judged(25, 40)[0].begin.right);
}

TEST(ClosedFormAgreement, AllowsTheFramesBesideAMomentThatIsOne) {
  EXPECT_FALSE(Judged(20, 40)[0].begin.right);
  for (const grammar::Tick near : {10, 20, 30}) EXPECT_TRUE(Judged(20, near)[0].begin.right);
}

TEST(ClosedFormAgreement, WaitsForTheNextFrameThatWasNotLost) {
  EXPECT_TRUE(Judged(45, 60)[0].begin.right);
  EXPECT_FALSE(Judged(45, 70)[0].begin.right);
}

TEST(ClosedFormAgreement, CountsWhatIsMissingAndWhatThereIsNot) {
  const std::vector<JudgedEvent> judged =
      ClosedFormAgreement({{"reaching(hand, cup)", 20.0 / 480, 70.0 / 480},
                           {"fixation(hand, cup)", 70.0 / 480, 80.0 / 480}},
                          Recording(), Recognised(20, 90));
  ASSERT_EQ(judged.size(), 3u);
  EXPECT_EQ(RightBoundaries(judged), 1);
  EXPECT_EQ(WrongBoundaries(judged),
            "fixation(hand, cup): 0.1458..0.1667 s, not recognised\n"
            "reaching(hand, cup): begins 0.0417 s; ends 0.1458 s, recognised 0.1875 s (+41.7 ms)\n"
            "sliding(hand, cup): there is none, recognised 0.1458..0.1667 s\n");
}

}  // namespace
}  // namespace prehend::witnesses

// SPDX-License-Identifier: Apache-2.0
#include "grammar/state/history.h"

#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

using testing::Scene;

void Push(History& history, const Frame& frame) {
  history.BeginFrame(frame.tick);
  for (std::size_t i = 0; i < frame.entities.size(); ++i) {
    if (i != Scene::kTray || history.now() == 0)
      history.SetSample(static_cast<int>(i), frame.entities[i], history.first_look());
  }
  for (const HandSample& hand : frame.hands) history.SetHand(hand, 0, history.first_look());
}

TEST(History, RemembersLooksOfEachFrame) {
  Scene scene;
  History history(scene.entity_table);
  for (int i = 0; i < 100; ++i) {
    scene.looks[Scene::kCup].p_WB_m.x() = i;
    scene.hand.trigger = i / 100.0;
    Push(history, scene.At(10 * i));
  }
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(history.Look(Scene::kCup, i).p_WB_m.x(), i);
    EXPECT_EQ(history.Hand(Scene::kHand, i)->look.trigger, i / 100.0);
    EXPECT_EQ(history.At(i).tick, 10 * i);
  }
  EXPECT_EQ(history.Hand(Scene::kCup, 5), nullptr);
  EXPECT_EQ(history.FirstNotBefore(41), 5);
  EXPECT_EQ(history.FirstNotBefore(40), 4);
  EXPECT_EQ(history.FirstNotBefore(5000), 100);
}

TEST(History, ForgetsButKeepsTheLookOfASleeper) {
  Scene scene;
  History history(scene.entity_table);
  scene.looks[Scene::kTray].asleep = true;
  scene.looks[Scene::kTray].p_WB_m.x() = 7;
  for (int i = 0; i < 100; ++i) {
    scene.looks[Scene::kCup].p_WB_m.x() = i;
    Push(history, scene.At(i));
  }
  history.Forget(60, 80);
  EXPECT_EQ(history.first(), 60);
  EXPECT_EQ(history.Look(Scene::kCup, 80).p_WB_m.x(), 80);
  EXPECT_EQ(history.Look(Scene::kTray, 80).p_WB_m.x(), 7);
}

struct Numbered {
  FrameNumber frame = 0;
};

TEST(History, GivesBackTheMemoryOfLooksThatWereNeededOnce) {
  Looks<Numbered> looks;
  FrameNumber now = 0;
  const auto show = [&](FrameNumber kept) {
    ForgetSamples(looks.samples, now - kept);
    looks.samples.PushBack().frame = now++;
    looks.GiveBack();
  };
  for (int i = 0; i < 1000; ++i) show(400);
  EXPECT_EQ(looks.samples.capacity(), 512u);
  // Needed from time to time: a steady load.
  for (int i = 0; i < 20'000; ++i) show(i % 1000 < 500 ? 400 : 2);
  EXPECT_EQ(looks.samples.capacity(), 512u);
  for (int i = 0; i < 10'000; ++i) show(2);
  EXPECT_EQ(looks.samples.capacity(), 8u);
  EXPECT_EQ(looks.samples.back().frame, now - 1);
}

}  // namespace
}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
#include "grammar/never_recognised.h"

#include <gtest/gtest.h>

#include "grammar/contents.h"
#include "tests/grammar/corpus.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

std::string Never(const Program& program, const FactsOfEpisode& facts) {
  std::string text;
  for (const NeverRecognised& one : FindNeverRecognised(program, facts))
    text += (text.empty() ? "" : ", ") + one.event + ": " + std::string(one.fact);
  return text;
}

TEST(NeverRecognised, EachFormNeedsItsFacts) {
  const auto program = testing::CompileText(R"(grammar g
event held(h: Hand, x: Thing) while sensor_sets(h, x) >= 2
event gripped(h: Hand) while trigger(h) > 0.5 until trigger(h) < 0.2
event open(h: Hand) while trigger(h) < 0.5 and speed(h) > 1 m/s
event seen(p: Person, x: Thing) while gazed(p, x)
event pressed(x: Thing, y: Thing) while force(x, y) > 1 N or speed(x) > 1 m/s
event squeezed(h: Hand, x: Thing) while force(h, x) > 1 N
event lifted(h: Hand, x: Thing) from held(h, any) begins to height(x) > 1 m begins
event left(h: Hand, x: Thing) rest of held(h, x) outside gripped(h)
event alone(x: Thing) while not touching_any(x)
condition touching_any(x: Thing) while held(any, x)
event twice(h: Hand, x: Thing) repeat held(h, x) at least 2, gap at most 1 s
event fast(h: Hand) while speed(h) > 1 m/s requires gripped(h)
event story(h: Hand, x: Thing) compose a: fast(h), b: held(h, x) where a before b
)");
  EXPECT_EQ(Never(*program, {}),
            "held: touches, gripped: closed grips, seen: gazes, squeezed: forces, lifted: touches, "
            "left: touches, twice: touches, fast: closed grips, story: closed grips");
  EXPECT_EQ(
      Never(*program, {.touches = true, .grips = true}),
      "held: sensor sets, seen: gazes, squeezed: forces, lifted: sensor sets, left: sensor sets, "
      "twice: sensor sets, story: sensor sets");
  EXPECT_EQ(
      Never(*program,
            {.touches = true, .sensor_sets = true, .grips = true, .gazes = true, .forces = true}),
      "");
}

TEST(NeverRecognised, WhatIsTippedNeedsOrientations) {
  const auto program = testing::CompileText(
      "grammar g\nevent tipped(x: Thing) while tilt(x) > 60 deg until tilt(x) < 45 deg\n"
      "event upright(x: Thing) while tilt(x) < 10 deg\n");
  EXPECT_EQ(Never(*program, {}), "tipped: orientations");
  EXPECT_EQ(Never(*program, {.orientations = true}), "");
}

TEST(NeverRecognised, TheLibraryNeedsTouchesAndFactsFromMotionNeedNone) {
  const auto measured = testing::CompileLibrary("pick_and_place");
  EXPECT_EQ(FindNeverRecognised(*measured, {}).size(), EventNames(*measured).size());
  EXPECT_EQ(Never(*testing::CompileLibrary("pick_and_place_from_motion"), {}), "");
}

}  // namespace
}  // namespace prehend::grammar

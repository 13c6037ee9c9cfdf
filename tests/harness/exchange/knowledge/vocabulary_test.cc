// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/exchange/knowledge/episode_graph.h"

namespace prehend::exchange {
namespace {

const Vocabulary& Shipped() {
  static const Vocabulary vocabulary = *Vocabulary::Load();
  return vocabulary;
}

TEST(Vocabulary, EventsHaveTheirShortNamesAndConcepts) {
  const EventTerm reaching = Shipped().TermOf("reaching");
  EXPECT_EQ(reaching.name, "knowrob:Reaching");
  EXPECT_EQ(reaching.base, "soma:PhysicalAction");
  EXPECT_EQ(reaching.relation, "dul:executesTask");
  EXPECT_EQ(reaching.concept_name, "knowrob:ReachingTask");
  EXPECT_EQ(Shipped().TermOf("fixation").name, "knowrob:PreGrasping");
  EXPECT_EQ(Shipped().TermOf("supported_by").relation, "dul:isClassifiedBy");
  EXPECT_EQ(Shipped().TermOf("pinching").base, "soma:PhysicalAction") << "a kind of grasping";
}

TEST(Vocabulary, OtherWordsAreMadeByOneRule) {
  EXPECT_EQ(Shipped().TermOf("wiping_off").name, "knowrob:WipingOff");
  EXPECT_EQ(Shipped().TermOf("wiping_off").base, "");
  EXPECT_EQ(Shipped().PropertyOf("hand"), "knowrob:performedBy");
  EXPECT_EQ(Shipped().PropertyOf("main_vessel"), "knowrob:mainVessel");
  EXPECT_EQ(Shipped().StyleOf("medium_wrap"), "knowrob:MediumWrapStyle");
  EXPECT_EQ(Shipped().StyleOf("claw"), "knowrob:ClawStyle");
  EXPECT_EQ(Shipped().ClassOf("MilkCarton"), "knowrob:MilkCarton");
}

TEST(Vocabulary, AWordNeverMeansTwoThings) {
  EXPECT_EQ(Shipped().ClassOf("Grasping"), "knowrob:GraspingObject");
  EXPECT_EQ(Shipped().TermOf("task").name, "knowrob:TaskEvent");
  EXPECT_EQ(Shipped().ClassOf("Movable"), "knowrob:Movable");
}

}  // namespace
}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
#include "grammar/describe.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/grammar/corpus.h"

namespace prehend::grammar {
namespace {

const RuleDescription& Find(const GrammarDescription& description, const std::string& name) {
  const auto found = std::find_if(description.rules.begin(), description.rules.end(),
                                  [&](const RuleDescription& rule) {
                                    return rule.head.find(" " + name + "(") != std::string::npos;
                                  });
  EXPECT_NE(found, description.rules.end()) << name;
  return *found;
}

TEST(Describe, BoundsDecisionsAndHistory) {
  const GrammarDescription d = Describe(*testing::CompileLibrary("pick_and_place"));
  EXPECT_EQ(d.history_s, 10.25);  // reach_back, and half of reach_window
  // Gaps of 60 ms, two sets for 20, and 10 in which a hand could begin to open.
  EXPECT_DOUBLE_EQ(Find(d, "grasping").latency.seconds, 0.09);
  EXPECT_TRUE(Find(d, "grasping").latency.until_end_of.empty());
  EXPECT_EQ(Find(d, "reaching").latency.until_end_of, std::set<std::string>{"contact"});
  EXPECT_DOUBLE_EQ(Find(d, "picking_up").latency.seconds, 3.44);
  // Where it lands, all about the way there is known; whether it slips is known 20 ms later.
  EXPECT_DOUBLE_EQ(Find(d, "putting_down").latency.seconds, 0.14);
  EXPECT_DOUBLE_EQ(Find(d, "moving_along").latency.seconds,
                   0.12 + 0.05 + 0.05 + 0.05 + 0.15);  // support, half a window, dip, jerk, pause
  EXPECT_EQ(Find(d, "contact").watched, "pairs that touch");
}

TEST(Describe, HistoryHasTheDigitsThatWereWritten) {
  GrammarDescription sum;
  sum.history_s = 0.1 + 0.05;
  EXPECT_NE(Text(sum).find("poses of the last 0.15 s, "), std::string::npos) << Text(sum);
}

// What is promised holds on the corpus: no event is decided later than its bound and the ends it
// waits for.
TEST(Describe, PromisesAreKeptOnTheCorpus) {
  const GrammarDescription d = Describe(*testing::CompileLibrary("pick_and_place"));
  for (const auto& c :
       testing::ReadCorpus(PREHEND_SOURCE_DIR "/tests/grammar/corpus/pick_and_place.txt")) {
    for (const NamedEvent& event : testing::RunCase(c).timeline.events) {
      const Wait& wait = Find(d, event.event).latency;
      if (!wait.until_end_of.empty()) continue;
      constexpr double kMaxFrame_s = 2 * 0.0162;  // a gap and a window may each wait for a frame
      EXPECT_LE(static_cast<double>(event.decided - event.interval.end),
                testing::kCorpusTicksPerSecond * (wait.seconds + kMaxFrame_s))
          << c.title << ": " << event.Label();
    }
  }
}

TEST(Describe, TextListsLaws) {
  const std::string text = Text(Describe(*testing::CompileLibrary("contact")));
  EXPECT_NE(text.find("\nlaw supports_lie_inside_contacts(object: Movable, support: Thing)\n"
                      "    supported_by(object, support) lies inside contact(object, support)\n"),
            std::string::npos)
      << text;
}

TEST(Describe, TextListsParametersWithTheirPlaces) {
  const std::string text = Text(Describe(*testing::CompileLibrary("grasp", {{"grip_on", "0.5"}})));
  EXPECT_NE(
      text.find("param grip_on      = 0.5      # grammar/library/grasp.grammar:4, overridden\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("event grasping(hand: Hand, object: Thing)\n    decided: at most 0.09 s "
                      "after it has ended; evaluated"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace prehend::grammar

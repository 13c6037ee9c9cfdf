// SPDX-License-Identifier: Apache-2.0
// Episodes to ask about: shipped scenarios, each played once per test binary, and frames written by
// hand.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/episode/episode/episode.h"
#include "harness/show/explain/explain.h"
#include "harness/show/explain/query.h"
#include "tests/grammar/scene.h"

namespace prehend::show::testing {

inline constexpr const char* kSlide = "slide/carton_slides_then_is_transported";

/// `name` is skill/name; `settings` as for --set.
inline grammar::ReplayMonitor& Played(const std::string& name,
                                      const std::vector<std::string>& settings = {}) {
  static std::map<std::string, Watched> played;
  std::string key = name;
  for (const std::string& setting : settings) key += " " + setting;
  Watched& watched = played[key];
  if (!watched.past) {
    const std::string root = PREHEND_SOURCE_DIR;
    Result<episode::Episode> episode =
        episode::OpenEpisode({.file = root + "/scenarios/" + name + ".yaml"}, {"", settings}, root);
    if (!episode) throw std::runtime_error(Format(episode.error()));
    watched = Watch(*episode);
    EXPECT_EQ(watched.problem + watched.failure, "");
  }
  return *watched.past;
}

/// A hand, a cup and a tray, ten milliseconds per frame.
class Stage {
 public:
  explicit Stage(const std::string& grammar_text)
      : past_(std::make_unique<grammar::ReplayMonitor>(
            grammar::testing::CompileText("grammar test\n" + grammar_text), scene.entity_table)) {}

  void Show(int frames = 1) {
    for (int i = 0; i < frames; ++i) {
      past_->Advance(scene.At(tick_));
      tick_ += 10;
    }
  }
  void CupAt(double x_m) { scene.looks[scene.kCup].p_WB_m.x() = x_m; }
  void CupUpAt(double z_m) { scene.looks[scene.kCup].p_WB_m.z() = z_m; }
  void Touch(bool touches) {
    scene.touches.clear();
    if (touches) scene.touches.push_back({.a = scene.kHand, .b = scene.kCup});
  }
  grammar::ReplayMonitor& Finish() {
    past_->Finish(tick_);
    return *past_;
  }

  grammar::testing::Scene scene;

 private:
  std::unique_ptr<grammar::ReplayMonitor> past_;
  grammar::Tick tick_ = 0;
};

inline Ask Asked(grammar::ReplayMonitor& past, const std::string& text) {
  const Result<Ask> ask = ParseAsk("--event", text, past.program(), past.entity_table());
  EXPECT_TRUE(ask) << Format(ErrorsOf(ask));
  return ask.value_or(Ask{.rule = grammar::RuleId(0)});
}

/// The only event that answers.
inline WhyEvent Why(grammar::ReplayMonitor& past, const std::string& text) {
  const std::vector<WhyEvent> events = ExplainEvents(past, Asked(past, text));
  EXPECT_EQ(events.size(), 1) << text;
  return events.empty() ? WhyEvent{} : events.front();
}

inline WhyMissing WhyNot(grammar::ReplayMonitor& past, const std::string& text) {
  const Ask ask = Asked(past, text);
  EXPECT_TRUE(ExplainEvents(past, ask).empty()) << text << " did happen";
  return ExplainMissing(past, ask);
}

/// The first reason of this clause, at any depth; null when there is none.
inline const Reason* Find(const Reasons& reasons, const std::string& clause) {
  for (const Reason& reason : reasons) {
    if (reason.what == clause) return &reason;
    if (const Reason* inner = Find(reason.because, clause)) return inner;
  }
  return nullptr;
}

/// The reason is there, so marked; its reading, if it has one, is on the right side of its limit.
inline void ExpectReason(const Reasons& reasons, const std::string& clause, Reason::Mark mark,
                         std::optional<bool> above = {}) {
  const Reason* reason = Find(reasons, clause);
  ASSERT_NE(reason, nullptr) << clause;
  EXPECT_EQ(reason->mark, mark) << clause << ": " << reason->how;
  ASSERT_EQ(reason->reading.has_value(), above.has_value()) << clause;
  if (above) {
    EXPECT_EQ(reason->reading->value >= reason->reading->limit, *above) << reason->how;
  }
}

}  // namespace prehend::show::testing

// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/export/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grammar/base/frame.h"
#include "grammar/contents.h"
#include "harness/episode/episodes/schema.h"

namespace prehend::exchange {

Result<Motion> Motion::Of(episode::Episode& episode, bool other_grammar) {
  Motion motion(episode);
  std::string uuid;
  if (episode.row()) uuid = episode.row()->uuid;
  if (episode.row() ? !other_grammar : episode.was_simulated()) {
    Result<grammar::Timeline> recorded = episode.Recorded();  // of a scenario: plays it
    if (!recorded) return tl::unexpected(std::move(recorded.error()));
    motion.timeline = std::move(*recorded);
  }
  if (!episode.row() || other_grammar) {
    PREHEND_TRY(episode::RunResult run, episode.Run(false));
    if (uuid.empty()) uuid = fmt::format("{} {:016x}", episode.name().scenario, run.state_hash);
    uuid = episode::UuidOf(uuid + " " + GrammarName(*episode.program()));
    motion.timeline = std::move(run.timeline);
  }
  for (std::size_t i = 0; i < motion.timeline.events.size(); ++i)
    motion.uuids.push_back(episode::UuidOfEvent(uuid, i));
  motion.LookAtAll();
  return motion;
}

void Motion::LookAtAll() {
  header = episode_->Header();
  if (const episode::Recording* recording = episode_->recording()) {
    says_its_end = recording->says_its_end;
    // Looks that were missing for a short time stand in the frames, and count as they are.
    const auto has_gaps = [](const episode::LookGaps& gaps) { return gaps.gaps > 0; };
    if (std::ranges::any_of(recording->gaps, has_gaps)) header.bridge_s = 0;
  }
  seen.resize(table().entities.size());
  const episode::Episode::End end = episode_->EachFrame([&](const grammar::Frame& frame) {
    ++frames;
    for (std::size_t i = 0; i < frame.entities.size(); ++i) {
      const grammar::EntitySample& look = frame.entities[i];
      Seen& of = seen[i];
      of.has_joint = of.has_joint || look.joint_position != 0 || look.joint_fraction != 0;
      if (!grammar::IsTracked(look)) continue;
      if (of.looks++ == 0) of.first = of.shut = of.open = look;
      if (look.joint_fraction < of.shut.joint_fraction) of.shut = look;
      if (look.joint_fraction > of.open.joint_fraction) of.open = look;
      of.moves = of.moves || look.p_WB_m != of.first.p_WB_m ||
                 look.q_WB.coeffs() != of.first.q_WB.coeffs();
    }
    for (const grammar::HandSample& hand : frame.hands) {
      Seen& of = seen[static_cast<std::size_t>(hand.entity)];
      const grammar::EntitySample& look = frame.entities[static_cast<std::size_t>(hand.entity)];
      of.most_grip = std::max(of.most_grip, hand.trigger);
      if (!of.ahead_B && grammar::IsTracked(look))
        of.ahead_B = look.q_WB.conjugate() * hand.ahead_W;
    }
  });
  end_tick = end.tick;
  failure = end.failure;
}

void Motion::EachFrame(const Look& look) const { episode_->EachFrame(look); }

std::uint64_t Motion::Nanoseconds(grammar::Tick tick) const {
  return static_cast<std::uint64_t>(std::llround(Seconds(tick) * 1e9));
}

}  // namespace prehend::exchange

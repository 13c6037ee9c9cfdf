// SPDX-License-Identifier: Apache-2.0
// Looks that are missing: for a short time an entity is as it was seen last, then nobody knows.
// Tested by tests/program/not_tracked_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::episode {

/// How long an entity was not tracked, of an episode.
struct LookGaps {
  std::size_t gaps = 0;
  grammar::Tick bridged = 0, unknown = 0;  ///< ticks of them all
};

/// Takes the frames of an episode one after another.
class GapTolerance {
 public:
  GapTolerance() = default;
  /// `most`: for so many ticks after its last look an entity is as it was then.
  GapTolerance(std::size_t entities, grammar::Tick most) : most_(most), seen_(entities) {}

  struct Seen {
    grammar::Tick tick = 0;
    grammar::EntitySample look;
  };
  /// The last look of an entity, if it still counts at this tick.
  const Seen* LastOf(std::size_t entity, grammar::Tick tick) const;

  /// Replaces what is not tracked and still counts, by the last look with its velocity.
  void Fill(grammar::Tick tick, std::vector<grammar::EntitySample>& looks);

  /// By entity.
  std::vector<LookGaps> Gaps() const;

 private:
  struct Entity {
    std::optional<Seen> last;
    bool tracked = true;  ///< in the last frame
    LookGaps gaps;
  };
  grammar::Tick most_ = 0;
  std::optional<grammar::Tick> before_;  ///< the last frame
  std::vector<Entity> seen_;
};

/// A line for each entity that was not tracked for a while; "" if there is none.
std::string GapsText(const grammar::EntityTable& table, const std::vector<LookGaps>& gaps);

}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// Watches a run and finds which of the scenario's outcomes it ended with. Tested by
// tests/harness/episode/run/outcome_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario/variations.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {

/// The outcome of a run that fits none of the scenario's outcomes.
inline constexpr const char* kOtherOutcome = "other";

class OutcomeWatch {
 public:
  /// Both must outlive the watch.
  OutcomeWatch(const physics::Scene& scene, const std::vector<scenario::Outcome>& outcomes);

  /// To be called with every snapshot, in order.
  void Look(const physics::Snapshot& snapshot);
  /// After the last snapshot: the first outcome whose conditions all hold, or kOtherOutcome.
  std::string Judge(const physics::Snapshot& last) const;

 private:
  /// A condition with a time of its own.
  struct TimedCondition {
    std::int64_t tick;
    std::size_t outcome, condition;
    bool holds;
  };
  bool Holds(const scenario::Outcome::Condition& condition,
             const physics::Snapshot& snapshot) const;

  double ShareInside(const scenario::Outcome::Condition& condition,
                     const physics::Snapshot& snapshot) const;

  const physics::Scene& scene_;
  const std::vector<scenario::Outcome>& outcomes_;
  std::vector<TimedCondition> timed_;
};

}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// Watches a run and tells which of a scenario's outcomes it came to. Tested by
// tests/harness/run/outcome_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/variations.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::harness {

/// What trials call a run that is none of its scenario's outcomes.
inline constexpr const char* kOtherOutcome = "other";

class OutcomeWatch {
 public:
  /// Both outlive the watch.
  OutcomeWatch(const physics::Scene& scene, const std::vector<Outcome>& outcomes);

  /// Every snapshot, in order.
  void Look(const physics::Snapshot& snapshot);
  /// The first outcome whose conditions all hold, judged after the last snapshot, or
  /// `kOtherOutcome`.
  std::string Judge(const physics::Snapshot& last) const;

 private:
  struct Moment {
    std::int64_t tick;
    std::size_t outcome, condition;
    bool holds;
  };
  bool Holds(const Outcome::Condition& condition, const physics::Snapshot& snapshot) const;

  double ShareInside(const Outcome::Condition& condition, const physics::Snapshot& snapshot) const;

  const physics::Scene& scene_;
  const std::vector<Outcome>& outcomes_;
  std::vector<Moment> moments_;  ///< of the conditions that say when
};

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// Where an interval of `until A since F` begins: the walk back from its end.
// Tested by tests/grammar/engine/forms_test.cc and tests/grammar/reference/reference_test.cc
#pragma once

#include <vector>

#include "grammar/base/candidate_log.h"
#include "grammar/values/evaluate.h"

namespace prehend::grammar {

/// How far a walk may go: no further back than `first`, and over no pause longer than `idle`. And
/// how far it looks around: half of Approach::over_s and of still_s.
struct WalkLimits {
  FrameNumber first = 0;
  WalkBack::Stop at_first = WalkBack::Stop::kFirstFrame;  ///< why not before `first`
  Tick idle = 0;  ///< for an approach whose pauses are limited
  Tick over = 0;
  Tick still = 0;
};

/// What walks write into, so that none of them allocates: a median for each frame visited, the end
/// first, and the values that one is made of.
struct WalkMemory {
  std::vector<double> levels;
  std::vector<double> around;
};

/// Walks back from `end`, a frame at which `until` is true. `begin` is kNever while a value that it
/// needs is not known.
WalkBack WalkBackFrom(FrameNumber end, const UntilSinceRule& rule, RuleInstance& instance,
                      const WalkLimits& limits, const Evaluator& evaluator, const History& history,
                      WalkMemory& memory);

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// The times of a rule in ticks of the episode. Tested by tests/grammar/engine/forms_test.cc
#pragma once

#include <vector>

#include "grammar/program/program.h"
#include "grammar/state/history.h"

namespace prehend::grammar {

struct RuleTicks {
  Tick bridging = 0;
  Tick lasting = 0;
  Tick lasting_most = -1;  ///< negative: as long as it likes
  Tick idle = 0;
  Tick over = 0;   ///< half of Approach::over_s
  Tick still = 0;  ///< half of Approach::still_s
  Tick back = 0;
  Tick within = -1;                ///< the deadline; negative: there is none
  Tick nearest = 0;                ///< AnyRule::within_s
  Tick in_time = 0;                ///< what comes at most so late is still in time
  std::vector<Relations> clauses;  ///< of a composition

  bool IsTooLong(Tick ticks) const { return lasting_most >= 0 && ticks > lasting_most; }
};

RuleTicks TicksOf(const Rule& rule, const History& history);

/// How far before the newest frame the rule may ask for values, apart from windows around frames.
double LooksBack_s(const Rule& rule);

}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
// Made-up worlds for the speed figures: the changes of each frame, without physics.
// Tested by tests/bench/workload_test.cc
#pragma once

#include <cstdint>

#include "bench/yardsticks/change_log.h"

namespace prehend::bench {

inline constexpr grammar::Tick kWorldRate_hz = 240;  ///< a frame is a tick

/// `objects` objects on a table, each with a hand of its own, which picks it up and puts it down
/// once per `period_s`; in between, both rest. Entities: hands, objects, the table.
ChangeLog MakeStations(int objects, int frames, double period_s, std::uint64_t seed = 1);

/// The same without the frames that bring nothing, but with the last one.
ChangeLog LeaveOutEmptyFrames(const ChangeLog& log);

/// Touches that flicker, `per_frame` a frame, one object after the other.
enum class Flicker {
  kPressure,  ///< from one sensor set to another one: no rule depends on it
  kFact,      ///< from one sensor set to two and back, by a hand that is open: `sensor_sets >= 2`
              ///< changes, nothing begins
  kGrasp,     ///< likewise, by a hand that is closed: each is the begin or the end of a grasp
};
ChangeLog MakeFlicker(int objects, int frames, int per_frame, Flicker flicker);

}  // namespace prehend::bench

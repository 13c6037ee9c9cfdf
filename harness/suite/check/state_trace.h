// SPDX-License-Identifier: Apache-2.0
// How a run moved, as one short hash per entity and sensed tick: enough to find the first tick and
// entity at which two runs diverge. Kept per build below build/check/, since another compiler may
// round differently. Tested by tests/harness/suite/check/state_trace_test.cc
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::suite {

struct StateTrace {
  std::vector<std::string> entities;  ///< bodies, then hands
  std::vector<std::int64_t> ticks;
  std::vector<std::uint32_t> hashes;  ///< for each tick one per entity
  friend bool operator==(const StateTrace&, const StateTrace&) = default;
};

/// Of at most 20,000 snapshots; of a longer recording every n-th.
StateTrace TraceOf(const physics::Scene& scene, std::span<const physics::Snapshot> recording);

struct Divergence {
  std::int64_t tick = 0;
  std::string entity;  ///< the first that differs; "" when one run has more ticks or other entities
};

/// Whether both have states of the same ticks, as long as both last.
bool SameTicks(const StateTrace& a, const StateTrace& b);

/// Nothing when the two move the same at all ticks that both have, and are equally long.
std::optional<Divergence> FirstDivergence(const StateTrace& a, const StateTrace& b);

/// A text file; "" or what went wrong.
std::string WriteTrace(const std::filesystem::path& path, const StateTrace& trace);
/// Nothing when there is none or it is damaged.
std::optional<StateTrace> ReadTrace(const std::filesystem::path& path);

}  // namespace prehend::suite

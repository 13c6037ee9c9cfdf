// SPDX-License-Identifier: Apache-2.0
// What `prehend check` keeps in build/check/: of each scenario its last pass, with all inputs of
// it, and its duration. Losing it costs time only. Tested by
// tests/harness/suite/check/last_pass_test.cc
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/project_paths.h"
#include "harness/suite/check/verdict.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::suite {

/// The last time that a scenario agreed with its golden: it passed, or its timeline was accepted.
struct LastPass {
  std::string program;      ///< ProgramHash() of then
  std::string build;        ///< BuildText() of then; empty: not known
  bool passed = true;       ///< false: accepted, but not checked since
  bool pictures = false;    ///< its pictures were drawn, too
  ScenarioVerdict verdict;  ///< its `inputs` are the files that decided it
};

/// Paths of inputs that have changed since, sorted.
std::vector<std::string> ChangedInputs(const LastPass& record);

class LastPasses {
 public:
  explicit LastPasses(const std::filesystem::path& project_root)
      : folder_(std::filesystem::path(BuildFolder(project_root)) / "check") {}

  /// `scenario` is its id, here and below. Nothing without a readable record.
  std::optional<LastPass> Read(const std::string& scenario) const;

  /// Returns "" or what went wrong.
  std::string Write(const LastPass& record) const;

  /// Where the physics trace of that run is kept.
  std::filesystem::path TracePath(const std::string& scenario) const {
    return folder_ / (scenario + ".trace");
  }

  using Costs = std::map<std::string, double>;  ///< id -> seconds
  Costs ReadCosts() const { return ReadCostsOf(folder_ / "costs.json"); }
  static Costs ReadCostsOf(const std::filesystem::path& file);  ///< of any such file
  std::string WriteCosts(const Costs& costs) const;

 private:
  std::filesystem::path folder_;
};

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

/// "" or what went wrong.
std::string WriteTrace(const std::filesystem::path& path, const StateTrace& trace);
/// Nothing when there is none or it is damaged.
std::optional<StateTrace> ReadTrace(const std::filesystem::path& path);

}  // namespace prehend::suite

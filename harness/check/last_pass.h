// SPDX-License-Identifier: Apache-2.0
// What `prehend check` remembers below build/check/, and never in the tree: per scenario the last
// time that it agreed with its golden, with what that depended on, and how long each one took.
// Losing it costs time only. Tested by tests/harness/check/last_pass_test.cc
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "harness/base/content_hash.h"
#include "harness/check/verdict.h"

namespace prehend::harness {

/// The last time that a scenario agreed with its golden: it passed, or what it yielded was
/// accepted.
struct CheckRecord {
  std::string program;      ///< ProgramHash() of then
  bool passed = true;       ///< checked; what was only accepted has to be checked yet
  bool pictures = false;    ///< whether pictures were drawn, too
  ScenarioVerdict verdict;  ///< its `inputs` are the files that decided it
};

/// Inputs of `record` that are no longer what they were, in order; paths.
std::vector<std::string> ChangedInputs(const CheckRecord& record);

class CheckRecords {
 public:
  explicit CheckRecords(const std::filesystem::path& project_root)
      : folder_(project_root / "build" / "check") {}

  /// `scenario` is its id, here and below. Nothing when there is none, or when it cannot be read.
  std::optional<CheckRecord> Read(const std::string& scenario) const;

  /// Returns "" or what went wrong.
  std::string Write(const CheckRecord& record) const;

  /// Where the physics trace of that run is kept.
  std::filesystem::path TracePath(const std::string& scenario) const {
    return folder_ / (scenario + ".trace");
  }

  using Costs = std::map<std::string, double>;  ///< id -> seconds
  Costs ReadCosts() const;
  std::string WriteCosts(const Costs& costs) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace prehend::harness

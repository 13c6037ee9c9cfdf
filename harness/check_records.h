// SPDX-License-Identifier: Apache-2.0
// What `prehend check` remembers below build/check/, and never in the tree: per scenario the last
// verdict that was a pass, with what it depended on, and how long each one took. Losing it costs
// time only. Tested by tests/harness/check_records_test.cc
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "harness/content_hash.h"
#include "harness/verdict.h"

namespace prehend::harness {

/// The last pass of a scenario.
struct CheckRecord {
  std::string program;      ///< ProgramHash() of then
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

  /// Where the physics trace of that pass is kept.
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

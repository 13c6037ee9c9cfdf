// SPDX-License-Identifier: Apache-2.0
// What `prehend check` keeps in build/check/: of each scenario its last pass, with all inputs of
// it, and its duration. Losing it costs time only. Tested by
// tests/harness/suite/check/last_pass_test.cc
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/project_paths.h"
#include "harness/suite/check/verdict.h"

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
  Costs ReadCosts() const;
  std::string WriteCosts(const Costs& costs) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace prehend::suite

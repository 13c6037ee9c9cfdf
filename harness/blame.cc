// SPDX-License-Identifier: Apache-2.0
// See blame.h. Tested by tests/harness/blame_test.cc
#include "harness/blame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

namespace prehend::harness {
namespace {

/// "scenarios/slide/x.yaml" and the like, and "the program".
std::vector<std::string> WhatChanged(const CheckRecord& last_pass, const Suspect& now,
                                     const std::string& root) {
  std::vector<std::string> changed;
  const auto add = [&](const std::string& path) {
    const auto relative = std::filesystem::path(path).lexically_relative(root).generic_string();
    changed.push_back(relative.empty() || relative.starts_with("..") ? path : relative);
  };
  for (const auto& [path, hash] : now.inputs) {
    const auto before = last_pass.verdict.inputs.find(path);
    if (before == last_pass.verdict.inputs.end() || before->second != hash) add(path);
  }
  for (const auto& [path, hash] : last_pass.verdict.inputs) {
    if (!now.inputs.contains(path)) add(path);
  }
  if (last_pass.program != now.program) changed.push_back("the program");
  return changed;
}

}  // namespace

std::string BlameText(const std::optional<CheckRecord>& last_pass,
                      const std::optional<PhysicsTrace>& its_trace, const Suspect& now,
                      const std::string& root) {
  if (!last_pass || !its_trace)
    return "blame: unknown, this scenario has not passed in this folder yet\n";
  std::string text = "blame: the grammar or the golden: everything moves as when this last passed";
  if (const auto parting = FirstParting(*its_trace, now.trace)) {
    text = "blame: physics";
    if (its_trace->entities != now.trace.entities) {
      text += ": other entities";
    } else {
      text += fmt::format(
          ": since {:.4f} s (tick {}) {} as when this last passed",
          static_cast<double>(parting->tick) / now.ticks_per_second, parting->tick,
          parting->entity.empty() ? "the run is not as long" : parting->entity + " does not move");
    }
  }
  const std::vector<std::string> changed = WhatChanged(*last_pass, now, root);
  return text + fmt::format("; changed since then: {}\n",
                            changed.empty() ? "no file, so it is the command line"
                                            : fmt::format("{}", fmt::join(changed, ", ")));
}

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// See harness/check/blame.h. Tested by tests/harness/check/blame_test.cc
#include "harness/check/blame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "harness/base/content_hash.h"

namespace prehend::harness {
namespace {

constexpr const char* kAgreed = "as when this last agreed with its golden";

/// "scenarios/slide/NAME.yaml" and the like, "the program", and what the command line asks for. A
/// grammar that the command line put in another's place did not change, nor did the one that it
/// replaces.
std::vector<std::string> WhatChanged(const CheckRecord& last_agreed, const Suspect& now,
                                     const std::string& root) {
  std::vector<std::string> changed;
  const auto add = [&](const std::string& path) {
    const auto relative = std::filesystem::path(path).lexically_relative(root).generic_string();
    changed.push_back(relative.empty() || relative.starts_with("..") ? path : relative);
  };
  const auto add_unless_replaced = [&](const std::string& path) {
    if (!now.other_grammar || !path.ends_with(".grammar")) add(path);
  };
  for (const auto& [path, hash] : now.inputs) {
    const auto before = last_agreed.verdict.inputs.find(path);
    if (before == last_agreed.verdict.inputs.end()) {
      if (hash != kNoFile) add_unless_replaced(path);  // who looks for more files found no more
    } else if (before->second != hash) {
      add(path);
    }
  }
  for (const auto& [path, hash] : last_agreed.verdict.inputs) {
    if (!now.inputs.contains(path)) add_unless_replaced(path);
  }
  if (last_agreed.program != now.program) changed.push_back("the program");
  changed.insert(changed.end(), now.options.begin(), now.options.end());
  return changed;
}

}  // namespace

std::string BlameText(const std::optional<CheckRecord>& last_agreed,
                      const std::optional<PhysicsTrace>& its_trace, const Suspect& now,
                      const std::string& root) {
  if (!last_agreed || !its_trace)
    return "blame: unknown, this scenario has not agreed with its golden in this folder yet\n";
  std::string text = fmt::format("blame: the grammar or the golden: everything moves {}", kAgreed);
  if (const auto divergence = FirstDivergence(*its_trace, now.trace)) {
    text = "blame: physics";
    if (its_trace->entities != now.trace.entities) {
      text += ": other entities";
    } else {
      text += fmt::format(": since {:.4f} s (tick {}) {} {}",
                          static_cast<double>(divergence->tick) / now.ticks_per_second,
                          divergence->tick,
                          divergence->entity.empty() ? "the run is not as long"
                                                     : divergence->entity + " does not move",
                          kAgreed);
    }
  } else if (!SameSample(*its_trace, now.trace)) {
    text = fmt::format("blame: the looks are at other ticks; where both look everything moves {}",
                       kAgreed);
  }
  const std::vector<std::string> changed = WhatChanged(*last_agreed, now, root);
  return text + fmt::format("; changed since then: {}\n",
                            changed.empty() ? "nothing that is known"
                                            : fmt::format("{}", fmt::join(changed, ", ")));
}

}  // namespace prehend::harness

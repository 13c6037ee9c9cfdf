// SPDX-License-Identifier: Apache-2.0
// The text of a scenario that does what its name says: `bottle_is_shaken` shakes a bottle. Tested
// by tests/program/new_command_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend::harness {

struct NewScenario {
  std::string text;  ///< YAML of a scenario called "name"
  std::string what;  ///< "shakes a bottle"
  /// What the name did not say, or said otherwise: a sentence; empty if all of it was understood.
  std::string note;
};

/// The names of all verbs, as `--verb` takes them, sorted.
std::vector<std::string> VerbNames();

/// Why there is no such verb, with the nearest one; empty if there is, or if `verb` is empty.
std::string WhyNoVerb(const std::string& verb);

/// `verb` is one of VerbNames(), or empty: then the name's own, else "carry".
NewScenario ComposeScenario(std::string_view name, std::string_view verb);

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// The text of a scenario that does what its name says: `bottle_is_shaken` shakes a bottle. Tested
// by tests/program/new_command_test.cc
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "harness/scenario/templates/templates.h"

namespace prehend::scenario {

struct NewScenario {
  std::string text;  ///< YAML of a scenario called "name"
  std::string what;  ///< "shakes a bottle"
  /// What the name did not say, or said otherwise: a sentence; empty if all of it was understood.
  std::string note;
  std::string template_path;
  /// For lines of `text` (from 1) where they stand in the template.
  std::map<int, grammar::Place> places;
};

/// Why there is no such verb, with the nearest one; empty if there is, or if `verb` is empty.
std::string WhyNoVerb(const std::string& verb, const std::vector<std::string>& known);

/// `verb` is that of one of the templates, or empty: then the name's own, else "carry".
NewScenario ComposeScenario(const Templates& templates, std::string_view name,
                            std::string_view verb);

/// An error in the text of a new scenario, at its place in the template.
grammar::Diagnostic InTemplate(const NewScenario& made, grammar::Diagnostic error);

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// The text of a scenario that does what its name says: `bottle_is_shaken` shakes a bottle. Tested
// by tests/program/new_command_test.cc
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/located.h"
#include "harness/base/base/result.h"

namespace prehend::scenario {

// The templates of new scenarios, scenarios/templates/: one file per verb, and the things that a
// name can mention. A project's own come before those that ship.

/// What a name without a verb means.
inline constexpr const char* kDefaultVerb = "carry";

/// A scenario whose thing is not named yet: its texts have marks like @thing@.
struct VerbTemplate {
  std::string name;                ///< as --like takes it
  std::string path;                ///< of its file
  std::vector<std::string> words;  ///< of a scenario's name, of which one is enough,
  std::vector<std::string> also;   ///< and of these one, too; empty: none is needed
  int order = 200;                 ///< where a name has words of two verbs, the lower one is meant
  std::vector<Located<std::string>> things;  ///< what it is done to, the default first
  std::string destination;                   ///< "in", "on" or empty
  Located<std::string> shows;
  std::vector<Located<std::string>> grammar;
  Located<std::string> picture;  ///< when
  std::string camera = "three_quarter";
  // Lines, as they stand below the scenario's keys of these names.
  Located<std::string> expects, entities, actors, script;
};

struct ThingTemplate {
  std::string word;
  std::string body;  ///< class, shape and mass, as the entity's keys in YAML
};

struct Templates {
  std::string frame;                ///< scenario.txt: a scenario with marks for a verb's parts
  std::vector<VerbTemplate> verbs;  ///< in their order
  /// What fits into a hand; what something can be put in or on, the default first.
  std::vector<ThingTemplate> things, in, on;
};

/// The names of all verbs, as `--like` takes them, sorted.
std::vector<std::string> VerbNames(const std::string& root);

Result<Templates> ReadTemplates(const std::string& root);

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

// SPDX-License-Identifier: Apache-2.0
// What happens in a new scenario, by its verb. Tested by tests/program/new_command_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend::harness {

/// A scenario whose thing is not named yet. In its texts `@o@` is the thing, `@body@` what it is,
/// `@a@` the thing with its article, `@d@` and `@destination@` where it goes.
struct Verb {
  std::string_view name;         ///< as --verb takes it
  std::string_view words;        ///< that a scenario's name has, of which one is enough,
  std::string_view also;         ///< and of these one, too; empty: none is needed
  std::string_view nouns;        ///< what it is done to, the default first; empty: to no noun
  std::string_view destination;  ///< "in", "on" or empty
  std::string_view shows;
  std::string_view expects;   ///< lines
  std::string_view grammar;   ///< a line
  std::string_view entities;  ///< lines
  std::string_view actors;    ///< lines
  std::string_view script;    ///< lines
  std::string_view picture;   ///< when, and from where if not from the usual side
};

/// Those that need two words come first.
const std::vector<Verb>& Verbs();

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// Things that the name of a new scenario can mention. Tested by
// tests/program/new_command_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace prehend::harness {

/// A thing that stands on a table and fits into a hand.
struct Noun {
  std::string_view word;
  std::string_view body;  ///< class, shape and mass, as the entity's keys in YAML
};

/// All of them; the first of those that a verb takes is its default.
const std::vector<Noun>& Nouns();

/// The noun of this word, also of its plural; null if there is none.
const Noun* FindNoun(std::string_view word);

}  // namespace prehend::harness

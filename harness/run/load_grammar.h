// SPDX-License-Identifier: Apache-2.0
// A grammar from its file, with the files it uses. Tested by tests/program/command_line_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/monitor.h"

namespace prehend::harness {

/// The file for a name of the library, or for a path (it has a slash, or ends with ".grammar").
std::string GrammarFile(const std::string& root, const std::string& name_or_path);

/// What it uses is looked for beside it, then in the library. `files` gets every path that was
/// looked at, whether there is a file or not.
grammar::CompileResult LoadGrammar(const std::string& root, const std::string& name_or_path,
                                   const grammar::Overrides& overrides = {},
                                   std::vector<std::string>* files = nullptr);

/// What is allowed and yet looks like a mistake: names that are not used; classes that nobody of
/// the entity table has, so that the rules about them never see anybody.
grammar::Diagnostics Warnings(const grammar::Program& program,
                              const grammar::EntityTable& entity_table);

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// Reads a grammar from its file, with the files that it uses. Tested by
// tests/program/command_line_test.cc
#pragma once

#include <map>
#include <string>
#include <vector>

#include "grammar/monitor.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

/// The file for a name of the library, or for a path (it has a slash, or ends with ".grammar").
std::string GrammarFile(const std::string& root, const std::string& name_or_path);

/// What is read instead of files: path -> text.
using GrammarTexts = std::map<std::string, std::string>;

/// Several are joined with '+': "pick_and_place+furniture+./kitchen.grammar" is compiled as one
/// grammar that uses all of them, in this order, and is called `pick_and_place_and_furniture_..`.
/// Grammars that it uses are searched beside it, then in the library. `files` receives every path
/// that was tried, whether or not the file exists.
grammar::CompileResult LoadGrammar(const std::string& root, const std::string& name_or_path,
                                   const grammar::Overrides& overrides = {},
                                   std::vector<std::string>* files = nullptr,
                                   const GrammarTexts& instead = {});

/// The same of a recording: what it names unless another one is `asked` for. A name that no grammar
/// has is an error where the recording, or the map that made it, says it.
grammar::CompileResult LoadGrammarOf(const EpisodeHeader& recording, const std::string& asked,
                                     const std::string& root,
                                     const grammar::Overrides& overrides = {},
                                     std::vector<std::string>* files = nullptr);

/// What is allowed but is probably a mistake: names that are not used; classes that no entity has,
/// so that their rules never apply.
grammar::Diagnostics Warnings(const grammar::Program& program,
                              const grammar::EntityTable& entity_table);

}  // namespace prehend::episode

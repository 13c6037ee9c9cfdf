// SPDX-License-Identifier: Apache-2.0
// Where things are: the project's root, and the grammars and hands of its libraries. A project of
// one's own (docs/projects.md) has its grammars and hands first; what ships with the program comes
// second. Which grammar segments the episode where none is named: a file of grammar/library/.
// Tested by tests/harness/episode/run/find_scenario_test.cc, tests/program/project_test.cc and
// tests/harness/scenario/read/read_scenario_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prehend {

inline constexpr const char* kGrammarEnding = ".grammar";
inline constexpr const char* kHandEnding = ".hand.yaml";

/// In the root of a project of one's own.
inline constexpr const char* kProjectFile = "prehend.yaml";

/// The folder that holds scenarios/, golden/, ..: $PREHEND_HOME if that is set; else the nearest
/// ancestor of the working directory that has a prehend.yaml; else ShippedRoot(), or the nearest
/// ancestor of the working directory with grammar/library.
std::optional<std::string> FindProjectRoot();

/// What ships with the program: the nearest ancestor of the executable, or of the library that this
/// code is in, with grammar/library or share/prehend/grammar/library; "" if there is none.
std::string ShippedRoot();
/// Whether `root` is a project of one's own, which uses what ships.
bool IsOwnProject(const std::string& root);

/// Whether `root` is what was installed with the program, which no command changes.
bool IsInstalled(const std::string& root);
inline constexpr const char* kStaysInstalled =
    "what is installed is not changed; a project of your own has scenarios and goldens: "
    "prehend new --project DIR";

/// Where what is made goes: ROOT/build; of what is installed, `build` in the working directory.
std::string BuildFolder(const std::string& root);

/// Whether the program is called in `root` or below it, or was told by $PREHEND_HOME to work there.
bool IsCalledIn(const std::string& root);

/// Where grammars are: root/grammars and root/grammar/library, those that exist, and for a project
/// without the latter what ships. Likewise hands: root/hands and root/physics/library.
std::vector<std::string> GrammarFolders(const std::string& root);
std::vector<std::string> HandFolders(const std::string& root);

/// The files in `folder` with this ending, sorted.
std::vector<std::string> FilesIn(const std::string& folder, std::string_view ending);

/// What they are called without the ending; only those with a ReadableName(), as no other can be
/// asked for.
std::vector<std::string> NamesIn(const std::string& folder, std::string_view ending);

/// What stands between '+' where several grammars are named.
std::vector<std::string> SplitGrammars(const std::string& joined);

/// The names of all grammars and hands of a project, sorted, each once.
std::vector<std::string> GrammarNames(const std::string& root);
std::vector<std::string> HandNames(const std::string& root);

/// A file of what ships, never that of a project: it may be code that is run.
std::string Shipped(const std::string& path);

/// FOLDER/NAME.grammar and FOLDER/NAME.hand.yaml in the first folder that has the file; if none
/// has, in the last one. `tried` gets the path, after the one where it was looked for first.
std::string GrammarPath(const std::string& root, const std::string& name,
                        std::vector<std::string>* tried = nullptr);
std::string HandPath(const std::string& root, const std::string& name,
                     std::vector<std::string>* tried = nullptr);

inline constexpr const char* kDefaultGrammar = "pick_and_place";

}  // namespace prehend

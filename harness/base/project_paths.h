// SPDX-License-Identifier: Apache-2.0
// Where things are: the project's root, and the grammars and hands of its libraries. Tested by
// tests/harness/run/find_scenario_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::harness {

inline constexpr const char* kGrammarEnding = ".grammar";
inline constexpr const char* kHandEnding = ".hand.yaml";

/// The folder that holds grammar/library, scenarios/, ...: $PREHEND_HOME if that is set, else the
/// nearest such ancestor of the executable, or of the working directory.
std::optional<std::string> FindProjectRoot();

/// root/grammar/library and root/physics/library.
std::string GrammarFolder(const std::string& root);
std::string HandFolder(const std::string& root);

/// The files in `folder` with this ending, sorted.
std::vector<std::string> FilesIn(const std::string& folder, std::string_view ending);

/// What they are called without the ending; only those with a ReadableName(), as no other can be
/// asked for.
std::vector<std::string> NamesIn(const std::string& folder, std::string_view ending);

/// root/grammar/library/NAME.grammar and root/physics/library/NAME.hand.yaml.
std::string GrammarPath(const std::string& root, const std::string& name);
std::string HandPath(const std::string& root, const std::string& name);

}  // namespace prehend::harness

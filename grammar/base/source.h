// SPDX-License-Identifier: Apache-2.0
// What a grammar is read from: its text, the texts that it uses, and settings of its parameters.
// Tested by tests/grammar/compile/compile_test.cc
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "grammar/base/diagnostic.h"

namespace prehend::grammar {

/// A grammar's text with the file name to report in diagnostics.
struct GrammarText {
  std::string file;
  std::string text;
};

/// Returns the text that `use NAME` asks for; nullopt: there is no such file.
using Includer = std::function<std::optional<GrammarText>(std::string_view name)>;

/// Parameter overrides, `name` -> `value with unit` as it would stand in the grammar ("25 cm",
/// "0.3").
using Overrides = std::map<std::string, std::string>;

/// A name, where it first stands in its file.
struct NameInSource {
  std::string name;
  std::string file;
  Place place;
};

}  // namespace prehend::grammar

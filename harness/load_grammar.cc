// SPDX-License-Identifier: Apache-2.0
// See load_grammar.h. Tested by tests/house/command_line_test.cc
#include "harness/load_grammar.h"

#include <filesystem>

#include "harness/library_paths.h"
#include "harness/text_file.h"

namespace prehend::harness {

namespace fs = std::filesystem;

std::string GrammarFile(const std::string& root, const std::string& name_or_path) {
  const bool is_path =
      name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".grammar");
  return is_path ? name_or_path : GrammarPath(root, name_or_path);
}

grammar::CompileResult LoadGrammar(const std::string& root, const std::string& name_or_path,
                                   const grammar::Overrides& overrides,
                                   std::vector<std::string>* files) {
  const auto note = [files](const std::string& path) {
    if (files) files->push_back(path);
  };
  const std::string file = GrammarFile(root, name_or_path);
  note(file);
  ReadResult<std::string> text = ReadTextFile(file);
  if (!text.value) return {nullptr, std::move(text.diagnostics)};
  const auto include = [&](std::string_view name) -> std::optional<grammar::GrammarText> {
    const std::string beside =
        (fs::path(file).parent_path() / (std::string(name) + ".grammar")).string();
    for (const std::string& candidate : {beside, GrammarPath(root, std::string(name))}) {
      note(candidate);
      ReadResult<std::string> used = ReadTextFile(candidate);
      if (used.value) return grammar::GrammarText{candidate, std::move(*used.value)};
    }
    return std::nullopt;
  };
  return grammar::Compile({file, std::move(*text.value)}, include, overrides);
}

}  // namespace prehend::harness

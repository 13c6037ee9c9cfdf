// SPDX-License-Identifier: Apache-2.0
#include "tests/grammar/corpus.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "grammar/program/program.h"

namespace prehend::grammar::testing {
namespace {

[[noreturn]] void Abort(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::abort();
}

}  // namespace

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) Abort("cannot read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Includer LibraryIncluder() {
  return [](std::string_view name) -> std::optional<GrammarText> {
    const std::string file = name.ends_with(".grammar")
                                 ? std::string(name)
                                 : "grammar/library/" + std::string(name) + ".grammar";
    if (!std::ifstream(std::string(PREHEND_SOURCE_DIR) + "/" + file)) return std::nullopt;
    return GrammarText{file, ReadFile(std::string(PREHEND_SOURCE_DIR) + "/" + file)};
  };
}

std::shared_ptr<const Program> CompileLibrary(const std::string& name, const Overrides& overrides) {
  const std::optional<GrammarText> text = LibraryIncluder()(name);
  if (!text) Abort("no grammar " + name);
  CompileResult result = Compile(*text, LibraryIncluder(), overrides);
  if (!result.program) Abort(Format(result.diagnostics));
  return result.program;
}

std::vector<CorpusCase> ReadCorpus(const std::string& path) {
  return ReadCorpusText(path, ReadFile(path));
}

std::vector<CorpusCase> ReadCorpusText(const std::string& path, const std::string& text) {
  Diagnostics diagnostics;
  std::vector<CorpusCase> cases = ReadDrawings({path, text}, diagnostics);
  if (!diagnostics.empty()) Abort(Format(diagnostics));
  for (CorpusCase& one : cases) {
    if (one.grammar.empty()) one.grammar = "pick_and_place";
  }
  return cases;
}

CorpusRun RunCase(const CorpusCase& c, int frames_per_second) {
  static std::map<std::string, std::shared_ptr<const Program>> programs;
  std::shared_ptr<const Program>& program = programs[c.grammar];
  if (!program) program = CompileLibrary(c.grammar);
  return RunCase(c, program, frames_per_second);
}

CorpusRun RunCase(const CorpusCase& c, const std::shared_ptr<const Program>& program,
                  int frames_per_second) {
  return WatchDrawing(program, c, frames_per_second);
}

}  // namespace prehend::grammar::testing

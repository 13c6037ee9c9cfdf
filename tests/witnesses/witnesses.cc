// SPDX-License-Identifier: Apache-2.0
// witnesses: what judges grammars and is no part of the program (tests/witnesses/README.md).
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/run/load_grammar.h"
#include "tests/witnesses/closed_form_score.h"

namespace prehend::harness {
namespace {

constexpr const char* kRoot = PREHEND_SOURCE_DIR;
constexpr const char* kStories = PREHEND_SOURCE_DIR "/tests/witnesses/stories";
constexpr const char* kUsage = R"(usage: witnesses closed-forms [--json] [GRAMMAR..]
       witnesses table [PREHEND]
closed-forms: grammars (default: pick_and_place and original_2020) and the oracle, on recordings
whose events are known on paper. table: README's table of witnesses; plays the whole library with
the program PREHEND (default: that of this build).
)";

int Complain(const grammar::Diagnostics& diagnostics) {
  std::cerr << grammar::Format(diagnostics);
  return 2;
}

Result<std::vector<ClosedFormScore>> Scores(std::vector<std::string> grammars) {
  if (grammars.empty()) grammars = {"pick_and_place", "original_2020"};
  std::vector<ClosedFormWitness> witnesses;
  for (const std::string& name : grammars) {
    const grammar::CompileResult compiled = LoadGrammar(kRoot, name, {});
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    witnesses.push_back(GrammarWitness(name, compiled.program));
  }
  witnesses.push_back(OracleWitness());
  return ScoreOnClosedForms(ClosedFormFiles(kStories), witnesses);
}

int RunClosedForms(std::vector<std::string> arguments) {
  const bool json = std::erase(arguments, "--json") > 0;
  const auto scores = Scores(arguments);
  if (!scores) return Complain(scores.error());
  std::cout << (json ? ClosedFormJson(*scores).dump(2) + "\n" : ClosedFormText(*scores));
  return 0;
}

int RunTable(const std::string& program) {
  const auto scores = Scores({});
  if (!scores) return Complain(scores.error());
  std::FILE* const pipe = popen(("'" + program + "' score --json").c_str(), "r");
  if (!pipe) return std::perror("popen"), 3;
  const auto score = nlohmann::json::parse(pipe, nullptr, false);
  if (pclose(pipe) != 0 || score.is_discarded()) {
    std::cerr << program << " score --json failed\n";
    return 3;
  }
  std::cout << WitnessTableWith(score, *scores);
  return 0;
}

int Run(const std::vector<std::string>& arguments) {
  const std::string what = arguments.empty() ? "" : arguments[0];
  if (what == "closed-forms") return RunClosedForms({arguments.begin() + 1, arguments.end()});
  if (what == "table" && arguments.size() <= 2)
    return RunTable(arguments.size() == 2 ? arguments[1] : PREHEND_BINARY_DIR "/prehend");
  std::cerr << kUsage;
  return 2;
}

}  // namespace
}  // namespace prehend::harness

int main(int argc, char** argv) { return prehend::harness::Run({argv + 1, argv + argc}); }

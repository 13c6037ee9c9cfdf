// SPDX-License-Identifier: Apache-2.0
// witnesses: what judges grammars and is no part of the program (tests/witnesses/README.md).
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/golden/golden.h"
#include "tests/witnesses/closed_form_score.h"
#include "tests/witnesses/metamorphic/metamorphic.h"

namespace prehend::witnesses {
namespace {

constexpr const char* kRoot = PREHEND_SOURCE_DIR;
constexpr const char* kStories = PREHEND_SOURCE_DIR "/tests/witnesses/stories";
constexpr const char* kUsage = R"(usage: witnesses closed-forms [--json] [GRAMMAR..]
       witnesses table [PREHEND]
       witnesses metamorphic SCENARIO TRANSFORM..
closed-forms: grammars (default: pick_and_place and original_2020) and the oracle, on recordings
whose events are known on paper. table: README's table of evaluators; plays the whole library with
the program PREHEND (default: that of this build). metamorphic: whether a scenario tells the same
story after each transform, as JSON; tests/witnesses/metamorphic/same_after_transforms does it with the library.
)";

int Complain(const grammar::Diagnostics& diagnostics) {
  std::cerr << grammar::Format(diagnostics);
  return 2;
}

Result<std::vector<ClosedFormScore>> Scores(std::vector<std::string> grammars) {
  if (grammars.empty()) grammars = {"pick_and_place", "original_2020"};
  std::vector<ClosedFormEvaluator> evaluators;
  for (const std::string& name : grammars) {
    const grammar::CompileResult compiled = episode::LoadGrammar(kRoot, name, {});
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    evaluators.push_back(EvaluatedGrammar(name, compiled.program));
  }
  evaluators.push_back(EvaluatedOracle());
  return ScoreOnClosedForms(ClosedFormFiles(kStories), evaluators);
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
  std::cout << EvaluatorTableWith(score, *scores);
  return 0;
}

int RunTransforms(const std::string& name, const std::vector<std::string>& transforms) {
  for (const std::string& transform : transforms) {
    if (std::ranges::find(TransformNames(), transform) != TransformNames().end()) continue;
    std::cerr << transform << ": wanted one of";
    for (const std::string& known : TransformNames()) std::cerr << " " << known;
    std::cerr << "\n";
    return 2;
  }
  auto loaded = episode::LoadRun(
      {.scenario_file = std::string(kRoot) + "/scenarios/" + name + ".yaml"}, kRoot);
  if (!loaded) return Complain(loaded.error());
  const auto golden = truth::GoldenFiles(kRoot).ReadGoldenOf(name);
  if (!golden) return Complain(golden.error());
  suite::CheckedRun checked{.id = name, .loaded = std::move(*loaded), .result = {}, .explain = ""};
  checked.result = episode::RunScenario(checked.loaded.scenario, checked.loaded.program);
  nlohmann::json verdicts = nlohmann::json::array();
  if (checked.result.status.kind == physics::RunStatus::Kind::kCompleted) {
    const truth::Golden here = suite::CompareWithGolden(*golden, checked).pending;
    for (const std::string& transform : transforms) {
      const TransformVerdict verdict = JudgeTransform(checked, here, transform);
      verdicts.push_back({{"transform", transform},
                          {"verdict", verdict.says},
                          {"why", verdict.why},
                          {"details", verdict.details}});
    }
  }
  std::cout << nlohmann::json{{"scenario", name}, {"transforms", verdicts}}.dump() << "\n";
  return 0;
}

int Run(const std::vector<std::string>& arguments) {
  const std::string what = arguments.empty() ? "" : arguments[0];
  if (what == "closed-forms") return RunClosedForms({arguments.begin() + 1, arguments.end()});
  if (what == "table" && arguments.size() <= 2)
    return RunTable(arguments.size() == 2 ? arguments[1] : PREHEND_BINARY_DIR "/prehend");
  if (what == "metamorphic" && arguments.size() > 2)
    return RunTransforms(arguments[1], {arguments.begin() + 2, arguments.end()});
  std::cerr << kUsage;
  return 2;
}

}  // namespace
}  // namespace prehend::witnesses

int main(int argc, char** argv) { return prehend::witnesses::Run({argv + 1, argv + argc}); }

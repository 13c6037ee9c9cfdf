// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/load_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "grammar/compile/compile.h"
#include "grammar/contents.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::episode {
namespace {

class ClaimDiagnostics {
 public:
  ClaimDiagnostics(const scenario::Scenario& scenario, const YamlDocument& document)
      : scenario_(scenario), text_(document.sources.front().text) {}

  void Add(const truth::Claim& claim, const std::vector<truth::ClaimProblem>& problems) {
    for (const truth::ClaimProblem& problem : problems) {
      const Where where = truth::PlaceIn(claim, problem.offset);
      const bool in_file = where.source == 0;
      diagnostics_.push_back(grammar::DiagnosticAt(in_file ? scenario_.file : "--set",
                                                   in_file ? text_ : "", where.place,
                                                   "expects: " + problem.message, problem.hint));
    }
  }

  grammar::Diagnostics Take() { return std::move(diagnostics_); }

 private:
  const scenario::Scenario& scenario_;
  const std::string& text_;
  grammar::Diagnostics diagnostics_;
};

struct Settings {
  std::vector<std::string> of_scenario;
  grammar::Overrides of_grammar;
  grammar::Diagnostics diagnostics;
};

/// `is_field`: whether a name means a field of the scenario.
Settings Split(const std::vector<std::string>& settings,
               const std::function<bool(const std::string&)>& is_field) {
  Settings split;
  std::set<std::string> seen;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    const auto report = [&](const char* message, const std::string& hint) {
      split.diagnostics.push_back(grammar::DiagnosticAt("--set", setting, {1, 1}, message, hint));
    };
    if (equals == std::string::npos || name.empty() || equals + 1 == setting.size()) {
      report("expected NAME=VALUE", "--set reach_radius=25cm, --set entities.milk.mass_kg=8");
    } else if (!seen.insert(name).second) {
      report("the same name is set twice", "give each --set a name of its own");
    } else if (is_field(name)) {
      split.of_scenario.push_back(setting);
    } else {
      split.of_grammar[name] = setting.substr(equals + 1);
    }
  }
  return split;
}

/// The scenario's own grammar must have the events that pictures ask for.
grammar::Diagnostics CheckPictures(const scenario::Scenario& scenario, const YamlDocument& document,
                                   const grammar::Program& program) {
  grammar::Diagnostics diagnostics;
  for (const scenario::PictureYaml& picture : scenario.pictures) {
    const auto problem = WhyNoEventTime(picture.at.value, program);
    if (!problem) continue;
    const bool in_file = picture.at.where.source == 0;
    diagnostics.push_back(grammar::DiagnosticAt(
        in_file ? scenario.file : "--set", in_file ? document.sources.front().text : "",
        picture.at.where.place, "at: " + problem->message, problem->hint));
  }
  return diagnostics;
}

/// The grammar of a scenario that cannot be read, so that all errors are reported at once. Empty if
/// it is not known, or not in the library (which the reader has reported).
std::string GrammarNamedIn(const Result<YamlDocument>& document, const RunRequest& request,
                           const std::string& root) {
  const bool is_set = std::ranges::any_of(
      request.settings, [](const auto& set) { return set.starts_with("grammar="); });
  if (!document || is_set) return "";
  const YamlNode* node = document->root.Find("grammar");
  const std::string name = node ? node->text : scenario::ScenarioYaml{}.grammar.value;
  return std::ranges::count(ProjectLibrary(root).grammars, name) > 0 ? name : "";
}

}  // namespace

truth::ClaimableEvents ClaimableIn(const scenario::Scenario& scenario,
                                   const grammar::Program& program) {
  return {.grammar = GrammarName(program),
          .events = EventSignatures(program),
          .entity_table = MakeEntityTable(scenario)};
}

grammar::Diagnostics ValidateClaims(const scenario::Scenario& scenario,
                                    const YamlDocument& document, const grammar::Program& program,
                                    bool is_own_grammar) {
  if (scenario.expects.empty()) return {};
  const truth::ClaimableEvents known = ClaimableIn(scenario, program);
  ClaimDiagnostics diagnostics(scenario, document);
  for (const truth::Claim& claim : scenario.expects) {
    diagnostics.Add(claim, truth::UnknownNames(claim, known));
    if (is_own_grammar) diagnostics.Add(claim, truth::Mismatches(claim, known));
  }
  return diagnostics.Take();
}

grammar::Diagnostics UndecidedClaims(const scenario::Scenario& scenario,
                                     const YamlDocument& document,
                                     const grammar::Program& program) {
  const truth::ClaimableEvents known = ClaimableIn(scenario, program);
  ClaimDiagnostics diagnostics(scenario, document);
  for (const truth::Claim& claim : scenario.expects) {
    std::vector<truth::ClaimProblem> mismatches = truth::Mismatches(claim, known);
    if (mismatches.empty()) continue;
    mismatches.resize(1);
    mismatches.front().message = "not judged: " + mismatches.front().message;
    diagnostics.Add(claim, mismatches);
  }
  grammar::Diagnostics warnings = diagnostics.Take();
  for (grammar::Diagnostic& warning : warnings) warning.is_warning = true;
  return warnings;
}

bool IsFieldOfScenario(const std::string& name) {
  const std::vector<std::string>& fields = scenario::ScenarioFormat().erased().keys;
  return name.find('.') != std::string::npos || std::ranges::find(fields, name) != fields.end();
}

Result<LoadedRun> LoadRun(const RunRequest& request, const std::string& root,
                          std::vector<std::string>* files) {
  const auto load_grammar = [&](const std::string& name, const grammar::Overrides& overrides) {
    return LoadGrammar(root, name, overrides, files, request.instead);
  };
  return LoadRun(request, root, ProjectLibrary(root, files), load_grammar, files);
}

Result<LoadedRun> LoadRun(const RunRequest& request, const std::string& root,
                          const scenario::ScenarioLibrary& library,
                          const GrammarLoader& load_grammar, std::vector<std::string>* files) {
  Settings settings = Split(request.settings, IsFieldOfScenario);
  if (!settings.diagnostics.empty()) return tl::unexpected(std::move(settings.diagnostics));
  if (files) files->push_back(request.scenario_file);
  Result<YamlDocument> document = ReadYamlFile(request.scenario_file);
  Result<scenario::Scenario> scenario =
      document
          ? scenario::ReadScenario(request.scenario_file, *document, settings.of_scenario, library)
          : tl::unexpected(document.error());
  const std::string grammar = !request.grammar.empty() ? request.grammar
                              : scenario               ? scenario->grammar
                                                       : GrammarNamedIn(document, request, root);
  grammar::CompileResult compiled =
      grammar.empty() ? grammar::CompileResult{} : load_grammar(grammar, settings.of_grammar);
  if (!scenario || !compiled.program) {
    grammar::Diagnostics diagnostics = ErrorsOf(scenario);
    std::ranges::move(compiled.diagnostics, std::back_inserter(diagnostics));
    return tl::unexpected(std::move(diagnostics));
  }
  const bool is_own_grammar = request.grammar.empty();
  grammar::Diagnostics misnamed =
      ValidateClaims(*scenario, *document, *compiled.program, is_own_grammar);
  if (is_own_grammar)
    std::ranges::move(CheckPictures(*scenario, *document, *compiled.program),
                      std::back_inserter(misnamed));
  if (!misnamed.empty()) return tl::unexpected(std::move(misnamed));
  scenario->grammar = GrammarName(*compiled.program);
  grammar::Diagnostics warnings = scenario->warnings;
  std::ranges::move(Warnings(*compiled.program, MakeEntityTable(*scenario)),
                    std::back_inserter(warnings));
  return LoadedRun{std::move(*scenario), std::move(compiled.program), std::move(warnings),
                   std::move(*document), grammar};
}

Result<grammar::Overrides> ParameterSettings(const std::vector<std::string>& settings) {
  Settings split = Split(settings, [](const std::string&) { return false; });
  if (!split.diagnostics.empty()) return tl::unexpected(std::move(split.diagnostics));
  return std::move(split.of_grammar);
}

std::string ScenarioId(const std::string& skill, const std::string& name) {
  return skill.empty() ? name : skill + "/" + name;
}

namespace fs = std::filesystem;

std::string GrammarFile(const std::string& root, const std::string& name_or_path,
                        std::vector<std::string>* tried) {
  std::error_code error;
  const bool is_path =
      name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".grammar") ||
      (name_or_path.find('.') != std::string::npos && fs::is_regular_file(name_or_path, error));
  if (is_path && tried) tried->push_back(name_or_path);
  return is_path ? name_or_path : GrammarPath(root, name_or_path, tried);
}

namespace {

/// A grammar that uses all of these: its text, and where each is.
struct JoinedGrammars {
  std::string name, text;
  std::string names;                                      ///< of all, joined with '+'
  std::map<std::string, std::string, std::less<>> paths;  ///< by name; only of files
};

JoinedGrammars Join(const std::string& joined) {
  JoinedGrammars all;
  std::string uses;
  for (const std::string& one : SplitGrammars(joined)) {
    const std::string stem = one.ends_with(kGrammarEnding) ? fs::path(one).stem().string() : one;
    if (stem != one) all.paths[stem] = one;
    all.name += (all.name.empty() ? "" : "_and_") + stem;
    all.names += (all.names.empty() ? "" : "+") + stem;
    uses += "use " + stem + "\n";
  }
  all.text = "grammar " + all.name + "\n" + uses;
  return all;
}

/// Whether the file ships with the program and no scenario names it: `use` of another grammar took
/// it along. It has no typing errors, and not every episode has all that it knows of.
bool IsUsedFromLibrary(const std::string& file, const std::string& grammar) {
  const std::string stem = fs::path(file).stem().string(), joint = "_and_";  // see Join()
  return fs::path(file).parent_path() == fs::path(ShippedRoot()) / "grammar/library" &&
         (joint + grammar + joint).find(joint + stem + joint) == std::string::npos;
}

// Warns of names in the grammar that nothing in the episode has. A class that every scenario knows
// is no typing error.
void WarnOfUnknownNames(const std::vector<grammar::NameInSource>& names,
                        const std::set<std::string>& known, std::string_view message,
                        const std::string& remedy, grammar::Diagnostics& warnings) {
  for (const grammar::NameInSource& named : names) {
    if (known.contains(named.name) || grammar::IsRootClass(named.name)) continue;
    const bool is_number = named.name.find_first_not_of("0123456789") == std::string::npos;
    const std::string near =
        is_number ? "" : grammar::NearestName(named.name, {known.begin(), known.end()});
    warnings.push_back(
        grammar::DiagnosticAt(named.file, ReadTextFile(named.file).value_or(""), named.place,
                              fmt::format("{} '{}'", message, named.name),
                              near.empty() ? remedy : "did you mean '" + near + "'?"));
    warnings.back().is_warning = true;
  }
}

}  // namespace

grammar::CompileResult LoadGrammar(const std::string& root, const std::string& name_or_path,
                                   const grammar::Overrides& overrides,
                                   std::vector<std::string>* files, const GrammarTexts& instead,
                                   const PathNames& shown) {
  const auto named = [&](const std::string& path) { return shown ? shown(path) : path; };
  const auto read = [&](const std::string& path) -> Result<std::string> {
    const auto text = instead.find(path);
    return text == instead.end() ? ReadTextFile(path) : text->second;
  };
  const bool is_joined = name_or_path.find('+') != std::string::npos && !fs::exists(name_or_path);
  const JoinedGrammars all = is_joined ? Join(name_or_path) : JoinedGrammars{};
  const std::string file = is_joined ? name_or_path : GrammarFile(root, name_or_path, files);
  Result<std::string> text = is_joined ? Result<std::string>(all.text) : read(file);
  const std::vector<std::string> known = ProjectLibrary(root).grammars;
  if (!text) {
    const bool is_name = file != name_or_path;
    if (is_name && std::ranges::count(known, name_or_path) == 0) {
      const std::string near = grammar::NearestName(name_or_path, known);
      const std::vector<std::string> folders = GrammarFolders(root);
      const std::string looked =
          folders.size() < 2 ? "" : fmt::format(" (looked for in {})", fmt::join(folders, " and "));
      text.error().front().hint =
          (near.empty() ? fmt::format("there are: {}", fmt::join(known, ", "))
                        : fmt::format("did you mean '{}'?", near)) +
          looked;
    }
    return {nullptr, std::move(text.error())};
  }
  // A file's own files are searched beside it. What the library uses may be replaced in the
  // project.
  fs::path beside = fs::path(file).parent_path();
  bool has_own = !is_joined && beside != GrammarFolders(root).back();
  grammar::Diagnostics unreadable;
  const auto include = [&](std::string_view used) -> std::optional<grammar::GrammarText> {
    const std::string name(used);
    std::vector<std::string> candidates;
    if (const auto path = all.paths.find(used); path != all.paths.end()) {
      candidates = {path->second};
      beside = fs::path(path->second).parent_path();
      has_own = true;
    } else if (name.ends_with(kGrammarEnding)) {
      candidates = {name};
    } else {
      if (has_own) candidates.push_back((beside / (name + kGrammarEnding)).string());
      GrammarPath(root, name, &candidates);
    }
    for (const std::string& candidate : candidates) {
      if (files) files->push_back(candidate);
      Result<std::string> found = read(candidate);
      if (found) return grammar::GrammarText{named(candidate), std::move(*found)};
      std::error_code error;
      if (fs::symlink_status(candidate, error).type() == fs::file_type::not_found) continue;
      // It is there: neither is another one meant, nor is there none.
      std::ranges::move(found.error(), std::back_inserter(unreadable));
      break;
    }
    return std::nullopt;
  };
  grammar::CompileResult compiled =
      grammar::Compile({named(file), std::move(*text)}, include, overrides, known);
  if (unreadable.empty()) return compiled;
  return {nullptr, std::move(unreadable)};
}

std::string NameToRecord(const LoadedRun& loaded) {
  const JoinedGrammars all = Join(loaded.grammar);
  const std::string name = GrammarName(*loaded.program);
  return all.name == name ? all.names : name;
}

grammar::CompileResult LoadGrammarOf(const EpisodeHeader& recording, const std::string& asked,
                                     const std::string& root, const grammar::Overrides& overrides,
                                     std::vector<std::string>* files) {
  const std::vector<std::string> own = SplitGrammars(recording.grammar), known = GrammarNames(root);
  grammar::CompileResult compiled =
      LoadGrammar(root, asked.empty() ? recording.grammar : asked, overrides, files);
  const auto other = std::ranges::find_if(own, [&](const std::string& one) {
    return GrammarFile(root, one) != one && std::ranges::count(known, one) == 0;
  });
  if (compiled.program || !asked.empty() || other == own.end() ||
      recording.grammar_named.file.empty())
    return compiled;
  grammar::Diagnostic unknown = recording.grammar_named;
  unknown.message = fmt::format("grammar: no grammar is called '{}'", *other);
  unknown.hint = compiled.diagnostics.front().hint;
  if (unknown.hint.starts_with("there are"))  // no name is near
    unknown.hint.insert(0, "if it is a file of yours, --grammar FILE names it; ");
  return {nullptr, {std::move(unknown)}};
}

grammar::Diagnostics Warnings(const grammar::Program& program,
                              const grammar::EntityTable& entity_table) {
  std::set<std::string> classes;
  std::set<std::string> sensor_sets;
  std::set<std::string> numbers;
  for (const grammar::EntityInfo& member : entity_table.entities) {
    classes.insert(member.classes.begin(), member.classes.end());
    sensor_sets.insert(member.sensor_sets.begin(), member.sensor_sets.end());
    for (std::size_t i = 1; i <= member.sensor_sets.size(); ++i) numbers.insert(std::to_string(i));
  }
  grammar::Diagnostics warnings = CompileWarnings(program);
  const auto asked_for = [&](std::vector<grammar::NameInSource> names) {
    std::erase_if(names, [&](const grammar::NameInSource& named) {
      return IsUsedFromLibrary(named.file, GrammarName(program));
    });
    return names;
  };
  WarnOfUnknownNames(asked_for(NamedClasses(program)), classes, "no entity of this episode is a",
                     "an entity is one by its 'class', or by a line of the scenario's 'classes'; "
                     "without one, what needs it never happens",
                     warnings);
  WarnOfUnknownNames(
      asked_for(NamedSensorSets(program)), sensor_sets, "no hand of this episode has a sensor set",
      sensor_sets.empty() ? "" : fmt::format("there are: {}", fmt::join(sensor_sets, ", ")),
      warnings);
  WarnOfUnknownNames(asked_for(NumberedSensorSets(program)), numbers,
                     "no hand of this episode has a sensor set",
                     fmt::format("a hand has {} of them here at most", numbers.size()), warnings);
  return warnings;
}

}  // namespace prehend::episode

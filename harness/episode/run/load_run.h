// SPDX-License-Identifier: Apache-2.0
// Reads what a run needs from files: the scenario and its compiled grammar, with the changes of the
// command line. Tested by tests/harness/episode/run/load_run_test.cc
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/monitor.h"
#include "harness/base/base/result.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/scenario/scenario/scenario.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::episode {

// Reads a grammar from its file, with the files that it uses. Tested by
// tests/program/command_line_test.cc

/// The file for a name of the library, or for a path (it has a slash, or ends with ".grammar").
/// `tried` gets it, and where it would be found first.
std::string GrammarFile(const std::string& root, const std::string& name_or_path,
                        std::vector<std::string>* tried = nullptr);

/// What is read instead of files: path -> text.
using GrammarTexts = std::map<std::string, std::string>;
/// How a file is called in diagnostics.
using PathNames = std::function<std::string(const std::string&)>;

/// Several are joined with '+': "pick_and_place+furniture+./kitchen.grammar" is compiled as one
/// grammar that uses all of them, in this order, and is called `pick_and_place_and_furniture_..`.
/// Grammars that it uses are searched beside it, then in the project, then in the library; those of
/// a grammar of the library not beside it. `files` receives every path that was tried, whether or
/// not the file exists.
grammar::CompileResult LoadGrammar(const std::string& root, const std::string& name_or_path,
                                   const grammar::Overrides& overrides = {},
                                   std::vector<std::string>* files = nullptr,
                                   const GrammarTexts& instead = {}, const PathNames& shown = {});

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

struct RunRequest {
  std::string scenario_file;
  std::string grammar;                ///< name or path; empty: the scenario's own
  std::vector<std::string> settings;  ///< "name=value": a field of the scenario when the name has a
                                      ///< dot or is that of a field, else a parameter
  GrammarTexts instead = {};          ///< of its grammars
};

struct LoadedRun {
  scenario::Scenario scenario;  ///< its `grammar` is the name of the grammar that is used
  std::shared_ptr<const grammar::Program> program;
  grammar::Diagnostics
      warnings;  ///< of scenario and grammar: what is allowed but is probably a mistake
  YamlDocument document = {};  ///< the scenario's file, without `settings`; empty of a recording
  std::string grammar = {};    ///< the name or path that `program` was compiled from
};

/// What a recording says of its grammar: its name, or those of several joined with '+'.
std::string NameToRecord(const LoadedRun& loaded);

/// `files` receives every path that was tried, also if there is no result.
Result<LoadedRun> LoadRun(const RunRequest& request, const std::string& root,
                          std::vector<std::string>* files = nullptr);

/// Compiles a grammar of this name or path with these parameters.
using GrammarLoader = std::function<grammar::CompileResult(const std::string& name_or_path,
                                                           const grammar::Overrides& overrides)>;

/// The same with a library and a loader that have been used before, so that what they have read is
/// not read again.
Result<LoadedRun> LoadRun(const RunRequest& request, const std::string& root,
                          const scenario::ScenarioLibrary& library,
                          const GrammarLoader& load_grammar,
                          std::vector<std::string>* files = nullptr);

/// Whether this name in a setting is a field of the scenario; otherwise it is a parameter of its
/// grammar.
bool IsFieldOfScenario(const std::string& name);

/// Settings "name=value" that are all parameters of a grammar.
Result<grammar::Overrides> ParameterSettings(const std::vector<std::string>& settings);

/// "skill/name", as in goldens, reports and on the command line.
std::string ScenarioId(const std::string& skill, const std::string& name);

// The claims of a scenario against the names of its entities and of the events of a grammar.
// Tested by tests/harness/episode/run/validate_claims_test.cc

/// The events of a grammar in this scenario.
truth::ClaimableEvents ClaimableIn(const scenario::Scenario& scenario,
                                   const grammar::Program& program);

/// Names that there are not; `document` is the scenario's. Of events and roles only if the grammar
/// is the scenario's own: another one may have others.
grammar::Diagnostics ValidateClaims(const scenario::Scenario& scenario,
                                    const YamlDocument& document, const grammar::Program& program,
                                    bool is_own_grammar);

/// A warning for each claim that this grammar cannot decide.
grammar::Diagnostics UndecidedClaims(const scenario::Scenario& scenario,
                                     const YamlDocument& document, const grammar::Program& program);

}  // namespace prehend::episode

// SPDX-License-Identifier: Apache-2.0
// Options that several commands have, declared once. Tested by
// tests/harness/cli/cli/command_tree_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command/options.h"

namespace prehend::cli {

constexpr int kMaxJobs = 256;
constexpr double kDefaultCollar_ms = 50;

Option ScenarioArgument();
Option EpisodeArgument();       ///< a scenario, an episode file or a recording
Option EpisodesArgument();      ///< any number of them
Option EpisodeFilesArgument();  ///< "files": no others
Option EpisodeOption();         ///< one of an episode file
Option EpisodesOption();        ///< some of episode files
Option GrammarOption();
Option SettingsOption();    ///< of a grammar and a scenario
Option ParametersOption();  ///< of a grammar alone
Option OutputOption(const std::string& help, const std::string& placeholder = "FILE");
Option JobsOption(const std::string& of_what);
Option FilterOption();
/// The program's help tells of both limits and of their defaults.
Option TimeLimitOption(double least_s, double most_s);
Option MemoryLimitOption();
Option JsonOption();

/// --truth, --map, --skip-bad-labels, --collar-ms.
std::vector<Option> TruthOptions(const std::string& help, const std::string& placeholder);

}  // namespace prehend::cli

// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/check_request.h"

#include <fmt/format.h>

#include "harness/base/base/quoting.h"

namespace prehend::suite {

std::vector<std::string> OptionsOf(const episode::GrammarChoice& changes) {
  std::vector<std::string> options;
  if (!changes.grammar.empty()) options.push_back("--grammar " + ShellQuoted(changes.grammar));
  for (const std::string& setting : changes.settings)
    options.push_back("--set " + ShellQuoted(setting));
  return options;
}

std::string CommandAbout(const char* name, const std::string& id,
                         const episode::GrammarChoice& changes) {
  std::string command = CommandText({name, id});
  for (const std::string& option : OptionsOf(changes)) command += " " + option;
  return command;
}

std::string ExplainCommand(const CheckRequest& request) {
  const episode::EpisodeName& episode = request.episode;
  if (request.listen) return "";
  if (!episode.number) return CommandAbout("explain", request.id, request.changes);
  return CommandAbout("explain", episode.file, request.changes) +
         fmt::format(" --episode {}", *episode.number);
}

std::string RepeatCommand(const CheckRequest& request) {
  return CommandAbout("check", request.episode.number ? request.episode.file : request.id,
                      request.changes) +
         (request.listen ? " --recogniser " + ShellQuoted(request.recogniser) : "");
}

}  // namespace prehend::suite

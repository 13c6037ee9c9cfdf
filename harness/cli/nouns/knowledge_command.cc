// SPDX-License-Identifier: Apache-2.0
// prehend episode knowledge: recorded episodes for knowledge bases. Tested by
// tests/program/knowledge_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/cli/command/command.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/exchange/knowledge/write_knowledge.h"

namespace prehend::cli {
namespace {

std::string FormProblem(const std::string& text) {
  return text == "owl" || text == "neem" ? "" : "found '" + text + "', wanted owl or neem";
}

ExitCode RunKnowledge(const ParsedOptions& options, const CommandContext& context) {
  auto episodes = FindEpisodesOrComplain("EPISODES", options, context, {});
  if (!episodes) return episodes.error();
  const std::vector<std::string> forms = options.All("--also");
  const auto asked = [&](const char* form) {
    return std::ranges::find(forms, form) != forms.end();
  };
  const std::string folder = options.TextOr("--output", "kb");
  const auto kept = episode::EpisodeKeeper(context.root, context.today, folder).KeepAll(*episodes);
  if (!kept) return Complain(context, kept.error());
  const Result<exchange::KnowledgeWritten> written = exchange::WriteKnowledge(
      *kept, {.root = context.root, .folder = folder, .owl = asked("owl"), .neem = asked("neem")});
  if (!written) return Complain(context, written.error());
  context.out << fmt::format("{}: {} episodes of {} tasks, {} events, {} statements\n", folder,
                             written->episodes, written->tasks, written->events,
                             written->statements);
  return ExitCode::kAgrees;
}

}  // namespace

Command KnowledgeCommand() {
  return {.name = "episode knowledge",
          .summary = "Write recorded episodes for knowledge bases (RDF, OWL, NEEM)",
          .examples =
              {"episode knowledge suite.episodes -o kb",
               "episode knowledge suite.episodes --episode 'slide/*' --also owl --also neem -o kb"},
          .options = {EpisodesArgument(),
                      {.name = "--output",
                       .help = "the folder; default: kb. It gets prehend.ttl, maps/ and episodes/",
                       .placeholder = "FOLDER",
                       .other_name = "-o",
                       .is_output = true},
                      {.name = "--also",
                       .help = "also as owl (RDF/XML beside each Turtle file) or neem (BSON "
                               "collections as mongodump writes them); may be repeated",
                       .placeholder = "owl|neem",
                       .rule = {.range = {}, .problem = FormProblem},
                       .repeatable = true},
                      EpisodesOption()},
          .run = RunKnowledge};
}

}  // namespace prehend::cli

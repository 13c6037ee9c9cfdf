// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/daily/recogniser_choice.h"

#include "harness/measure/score/found_events.h"

namespace prehend::cli {
namespace {

bool IsGrammar(const std::string& typed, const CommandContext& context) {
  return measure::SourceOf(typed, context.root).kind == measure::Source::Kind::kGrammar;
}

}  // namespace

suite::Listen ListenTo(const std::string& typed) {
  if (typed.empty()) return {};
  const bool is_folder = typed.starts_with("files:");
  const measure::Source source{
      is_folder ? measure::Source::Kind::kFiles : measure::Source::Kind::kProgram,
      is_folder ? typed.substr(6) : typed};
  return [source](episode::Episode& episode) -> Result<suite::Heard> {
    const measure::Asking asking{.sources = {source}, .time_limit_s = kRecogniserLimit_s};
    Result<measure::EpisodeToScore> said = measure::HeardIn(episode, asking);
    if (!said) return tl::unexpected(std::move(said.error()));
    return suite::Heard{std::move(said->found), std::move(said->failure), std::move(said->notes),
                        std::move(said->covers)};
  };
}

Option RecogniserOption() {
  return {.name = "--recogniser",
          .help =
              "hear this program, or the events in files:FOLDER, instead of the grammar "
              "(docs/recognisers.md)",
          .placeholder = "CMD"};
}

std::string GrammarOf(const ParsedOptions& options, const CommandContext& context) {
  const std::string typed = options.Text("--recogniser");
  return typed.empty() || !IsGrammar(typed, context) ? options.Text("--grammar") : typed;
}

std::string RecogniserOf(const ParsedOptions& options, const CommandContext& context) {
  const std::string typed = options.Text("--recogniser");
  return typed.empty() || IsGrammar(typed, context) ? "" : typed;
}

}  // namespace prehend::cli

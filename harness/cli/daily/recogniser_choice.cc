// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/daily/recogniser_choice.h"

#include "harness/measure/score/score.h"

namespace prehend::cli {

suite::Listen ListenTo(const std::string& typed) {
  const bool is_folder = typed.starts_with("files:");
  const measure::Source source{
      is_folder ? measure::Source::Kind::kFiles : measure::Source::Kind::kProgram,
      is_folder ? typed.substr(6) : typed};
  return [source](episode::Episode& episode) -> Result<suite::Heard> {
    const measure::Asking asking{.sources = {source}, .time_limit_s = kRecogniserLimit_s};
    PREHEND_TRY(measure::EpisodeToScore said, measure::HeardIn(episode, asking));
    return suite::Heard{std::move(said.found), std::move(said.failure), std::move(said.notes),
                        std::move(said.covers)};
  };
}

Option RecogniserOption() {
  return Value("--recogniser", "CMD",
               "hear this program, or the events in files:FOLDER, instead of the grammar "
               "(docs/recognisers.md)");
}

void HearWho(const ParsedOptions& options, suite::SuiteRequest& request) {
  const std::string typed = options.Text("--recogniser");
  if (typed.empty()) return;
  if (measure::SourceOf(typed, request.root).kind == measure::Source::Kind::kGrammar) {
    request.changes.grammar = typed;
  } else {
    request.recogniser = typed;
    request.listen = ListenTo(typed);
  }
}

}  // namespace prehend::cli

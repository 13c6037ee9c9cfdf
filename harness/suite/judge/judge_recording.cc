// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "harness/episode/episode/open_episode.h"
#include "harness/suite/judge/accept_golden.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/golden/golden_files.h"

namespace prehend::suite {
namespace {

constexpr int kToleratedFrames = 2;

grammar::Tick ToleranceOf(const episode::SegmentedRecording& segmented) {
  return kToleratedFrames * segmented.frame_ticks;
}

truth::Golden Propose(const JudgedRecording& judged, std::vector<std::string> derived,
                      std::optional<truth::Acceptance> acceptance) {
  if (derived.empty() && judged.golden) derived = judged.golden->derived;
  return ProposeGolden(judged.golden, judged.segmented.timeline,
                       {.scenario = judged.segmented.name,
                        .grammar = GrammarName(*judged.segmented.program),
                        .derived = std::move(derived),
                        .acceptance = std::move(acceptance),
                        .tolerance = ToleranceOf(judged.segmented)});
}

}  // namespace

std::string GoldenBeside(const std::string& recording) {
  return std::filesystem::path(recording).replace_extension(".timeline").string();
}

Result<JudgedRecording> JudgeRecording(const episode::RunRequest& request,
                                       const std::string& root) {
  Result<episode::Episode> recording =
      episode::OpenEpisode({.file = request.scenario_file, .origin = episode::Origin::kRecording},
                           {request.grammar, request.settings}, root);
  if (!recording) return tl::unexpected(std::move(recording.error()));
  Result<episode::SegmentedRecording> segmented = recording->SegmentRecorded();
  if (!segmented) return tl::unexpected(std::move(segmented.error()));
  return JudgeSegmented(std::move(*segmented), GoldenBeside(request.scenario_file));
}

Result<JudgedRecording> JudgeSegmented(episode::SegmentedRecording segmented,
                                       const std::string& golden_file) {
  auto golden = truth::ReadGoldenFile(golden_file, segmented.name);
  if (!golden) return tl::unexpected(std::move(golden.error()));
  JudgedRecording judged{.segmented = std::move(segmented),
                         .golden = std::move(*golden),
                         .comparison = {},
                         .proposed = {}};
  const grammar::Timeline& timeline = judged.segmented.timeline;
  const truth::Golden none{.ticks_per_second = timeline.ticks_per_second};
  judged.comparison =
      truth::Compare(judged.golden.value_or(none), timeline, ToleranceOf(judged.segmented));
  judged.proposed = Propose(judged, {}, std::nullopt);
  return judged;
}

std::string OtherGrammarText(const JudgedRecording& judged) {
  const std::string now = GrammarName(*judged.segmented.program);
  if (!judged.golden || judged.golden->grammar == now) return "";
  return fmt::format(
      "the golden is of grammar '{}', and this is what '{}' recognises; --grammar names another "
      "one\n",
      judged.golden->grammar, now);
}

std::string ReviewText(const JudgedRecording& judged, const std::string& explain) {
  if (!judged.golden) return EventLines(judged.proposed);
  return truth::DifferenceText(judged.comparison, explain) + OtherGrammarText(judged);
}

truth::Golden AcceptedRecording(const JudgedRecording& judged,
                                const std::vector<std::string>& derived,
                                truth::Acceptance acceptance) {
  return Propose(judged, derived, std::move(acceptance));
}

}  // namespace prehend::suite

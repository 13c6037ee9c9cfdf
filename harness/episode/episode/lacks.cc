// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episode/lacks.h"

#include <fmt/format.h>

#include "harness/base/base/quoting.h"

namespace prehend::episode {

std::string Lacks(const EpisodeName& episode, Need need) {
  const bool is_recording = episode.origin == Origin::kRecording;
  const std::string& file = episode.file;
  switch (need) {
    case Need::kScenario:
      if (episode.origin == Origin::kScenario) return "";
      return fmt::format("{} {}, so there is no scenario to simulate; '{}' prints its events", file,
                         is_recording ? "is a recording" : "was simulated before",
                         CommandText({"episode", "resegment", file}));
    case Need::kGroundTruth:
      if (!is_recording) return "";
      return episode.scenario +
             " was not simulated, so its physical truth is not known; score it against labels by "
             "people: --truth (docs/labels.md)";
    case Need::kRecordedEvents:
      if (episode.number) return "";
      return fmt::format("{} has no events that were recorded with it; '{}' keeps them", file,
                         is_recording ? CommandText({"import", file, "-o", "NAME.episodes"})
                                      : CommandText({"run", file, "--record", "NAME.episodes"}));
    case Need::kEpisodeFile:
      if (episode.number) return "";
      return fmt::format("{} is not kept in an episode file; '{}' makes one", file,
                         is_recording ? CommandText({"import", file, "-o", "NAME.episodes"})
                                      : CommandText({"run", file, "--record", "NAME.episodes"}));
    case Need::kGolden:
      if (!episode.number) return "";
      return is_recording
                 ? fmt::format(
                       "{} has no golden: that of a recording lies beside its JSON Lines; '{}'",
                       file, CommandText({"accept", "NAME.jsonl"}))
                 : fmt::format("{} has no golden: that of its scenario is accepted by name; '{}'",
                               file, CommandText({"accept", episode.scenario}));
  }
  return "";
}

std::string Lack(std::span<const EpisodeName> episodes, Need need) {
  for (const EpisodeName& episode : episodes) {
    if (std::string lack = Lacks(episode, need); !lack.empty()) return lack;
  }
  return "";
}

}  // namespace prehend::episode

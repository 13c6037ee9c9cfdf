// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episode/resegment_many.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "harness/base/process/worker_pool.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/truth/timeline/timeline_wire.h"

namespace prehend::physics {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunStatus, kind, tick, entity, reason, advice)

}  // namespace prehend::physics

namespace prehend::episode {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunHeading, name, skill, grammar, notes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunResult, status, ticks, is_unfinished, state_hash, timeline,
                                   outcome)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Resegmented, heading, run, differences, warnings, problem,
                                   nothing_left, finished)

namespace {

constexpr double kSliceTimeLimit_s = 3600;
constexpr std::size_t kSlicesPerJob = 2;
constexpr std::size_t kMostLines = 20;

std::vector<std::string> LinesOf(const grammar::Timeline& timeline, const RunResult& run) {
  RunResult shown;
  shown.status = run.status;
  shown.timeline = timeline;
  std::istringstream table(RunTable(shown));
  std::vector<std::string> lines;
  for (std::string line; std::getline(table, line);) lines.push_back(line);
  lines.pop_back();  // the status
  return lines;
}

bool IsEqual(const grammar::NamedEvent& a, const grammar::NamedEvent& b) {
  return a.event == b.event && a.roles == b.roles && a.interval == b.interval &&
         a.decided == b.decided && a.open_end == b.open_end && a.values == b.values;
}

/// Lines that only one of the two has.
std::string Differences(const grammar::Timeline& recorded, const RunResult& run) {
  if (std::ranges::equal(recorded.events, run.timeline.events, IsEqual)) return "";
  const std::vector<std::string> before = LinesOf(recorded, run), now = LinesOf(run.timeline, run);
  std::vector<std::string> lines;
  for (const std::string& line : before) {
    if (std::ranges::find(now, line) == now.end()) lines.push_back("- " + line);
  }
  for (const std::string& line : now) {
    if (std::ranges::find(before, line) == before.end()) lines.push_back("+ " + line);
  }
  if (lines.empty()) lines.push_back("the same events were decided at other times");
  std::string text;
  for (std::size_t i = 0; i < std::min(lines.size(), kMostLines); ++i) text += lines[i] + "\n";
  if (lines.size() > kMostLines) text += fmt::format("and {} more\n", lines.size() - kMostLines);
  return text;
}

/// Opens one episode after another.
class Worker {
 public:
  explicit Worker(const ResegmentRequest& request) : request_(request), opener_(request.root) {}

  Resegmented Run(const EpisodeName& name) {
    const auto failed = [](const grammar::Diagnostics& why) {
      return Resegmented{.problem = grammar::Format(why)};
    };
    Result<Episode> episode = opener_.Open(name, request_.choice);
    if (!episode) return failed(episode.error());
    Result<RunResult> run = episode->Run(request_.replay);
    if (!run) return failed(run.error());
    run->recording.clear();
    const LoadedRun& loaded = episode->loaded();
    const MissingFacts& missing = episode->missing();
    Resegmented result{.heading = HeadingOf(loaded.scenario, *run),
                       .run = std::move(*run),
                       .warnings = grammar::Format(loaded.warnings) + missing.warnings,
                       .nothing_left = missing.nothing_left,
                       .finished = !episode->row() || episode->row()->status != kBeingRecorded};
    if (!request_.compare || !result.finished) return result;
    const Result<grammar::Timeline> recorded = episode->Recorded();
    if (!recorded) return failed(recorded.error());
    result.differences = Differences(*recorded, result.run);
    return result;
  }

 private:
  const ResegmentRequest& request_;
  EpisodeOpener opener_;
};

}  // namespace

std::vector<Resegmented> ResegmentAll(const std::vector<EpisodeName>& episodes,
                                      const ResegmentRequest& request) {
  const std::size_t slices =
      std::min(episodes.size(), kSlicesPerJob * static_cast<std::size_t>(request.jobs));
  std::vector<WorkerJob> jobs;
  // Neighbours are often of one skill and equally long: each slice has some of all.
  for (std::size_t slice = 0; slice < slices; ++slice) {
    jobs.push_back([&, slice] {
      Worker worker(request);
      std::vector<Resegmented> of_slice;
      for (std::size_t i = slice; i < episodes.size(); i += slices)
        of_slice.push_back(worker.Run(episodes[i]));
      return ToWire(of_slice);
    });
  }
  const std::vector<WorkerResult> said =
      RunInWorkers(jobs, {.jobs = request.jobs, .time_limit_s = kSliceTimeLimit_s});
  std::vector<Resegmented> results(episodes.size());
  for (std::size_t slice = 0; slice < slices; ++slice) {
    std::vector<Resegmented> of_slice;
    if (said[slice].finished) of_slice = FromWire<std::vector<Resegmented>>(said[slice].output);
    for (std::size_t i = slice, k = 0; i < episodes.size(); i += slices, ++k) {
      results[i] = k < of_slice.size()
                       ? std::move(of_slice[k])
                       : Resegmented{.problem = "its process ended: " + said[slice].reason + "\n"};
      results[i].episode = episodes[i];
    }
  }
  return results;
}

}  // namespace prehend::episode

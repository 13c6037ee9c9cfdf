// SPDX-License-Identifier: Apache-2.0
// See harness/episode/resegment_many.h. Tested by tests/program/episodes_test.cc
#include "harness/episode/resegment_many.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/episode/open_episode.h"
#include "harness/episodes/write_rows.h"
#include "harness/process/worker_pool.h"
#include "harness/run/run_text.h"

namespace prehend::harness {
namespace {

using Json = nlohmann::json;

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

  Json Run(const EpisodeName& name) {
    Result<Episode> episode = opener_.Open(name, request_.choice);
    if (!episode) return {{"problem", grammar::Format(episode.error())}};
    const Result<RunResult> run = episode->Run(request_.replay);
    if (!run) return {{"problem", grammar::Format(run.error())}};
    const bool is_finished = !episode->row() || episode->row()->status != episodes::kRecording;
    Json said = {
        {"table", RunTable(*run)},
        {"json", RunJson(episode->loaded().scenario, *run).dump()},
        {"completed", run->status.kind == physics::RunStatus::Kind::kCompleted},
        {"nothing_left", episode->missing().nothing_left},
        {"finished", is_finished},
        {"warnings", grammar::Format(episode->loaded().warnings) + episode->missing().warnings}};
    if (!request_.compare || !is_finished) return said;
    const Result<grammar::Timeline> recorded = episode->Recorded();
    if (!recorded) return {{"problem", grammar::Format(recorded.error())}};
    said["differences"] = Differences(*recorded, *run);
    return said;
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
      Json all = Json::array();
      for (std::size_t i = slice; i < episodes.size(); i += slices)
        all.push_back(worker.Run(episodes[i]));
      return all.dump();
    });
  }
  const std::vector<WorkerResult> said =
      RunInWorkers(jobs, {.jobs = request.jobs, .time_limit_s = kSliceTimeLimit_s});
  std::vector<Resegmented> results(episodes.size());
  for (std::size_t slice = 0; slice < slices; ++slice) {
    const Json all = said[slice].finished ? Json::parse(said[slice].output) : Json::array();
    for (std::size_t i = slice, k = 0; i < episodes.size(); i += slices, ++k) {
      const Json one = k < all.size()
                           ? all[k]
                           : Json{{"problem", "its process ended: " + said[slice].reason + "\n"}};
      results[i] = {.episode = episodes[i],
                    .table = one.value("table", ""),
                    .json = one.value("json", ""),
                    .differences = one.value("differences", ""),
                    .warnings = one.value("warnings", ""),
                    .problem = one.value("problem", ""),
                    .nothing_left = one.value("nothing_left", false),
                    .completed = one.value("completed", false),
                    .finished = one.value("finished", false)};
    }
  }
  return results;
}

}  // namespace prehend::harness

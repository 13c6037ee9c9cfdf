// SPDX-License-Identifier: Apache-2.0
// See harness/episodes/resegment_many.h. Tested by tests/program/episodes_test.cc
#include "harness/episodes/resegment_many.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/episodes/write_rows.h"
#include "harness/process/worker_pool.h"
#include "harness/run/run_text.h"

namespace prehend::harness::episodes {
namespace {

using Json = nlohmann::json;

constexpr double kSliceTimeLimit_s = 3600;
constexpr std::size_t kSlicesPerJob = 2;
constexpr std::size_t kMostLines = 20;

bool Matches(const EpisodeRow& row, const std::string& only) {
  if (only.empty() || std::to_string(row.id) == only || row.scenario == only) return true;
  const std::size_t slash = row.scenario.rfind('/');
  if (slash != std::string::npos && row.scenario.substr(slash + 1) == only) return true;
  return fnmatch(only.c_str(), row.scenario.c_str(), 0) == 0;
}

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

/// Reads episodes of one file after another.
class Worker {
 public:
  explicit Worker(const ResegmentRequest& request) : request_(request), loader_(request.root) {}

  Json Run(const EpisodeName& name) {
    if (!file_ || file_->path() != name.file) {
      file_.reset();
      Result<EpisodeFile> opened = EpisodeFile::Open(name.file);
      if (!opened) return {{"problem", grammar::Format(opened.error())}};
      file_.emplace(std::move(*opened));
    }
    const auto row = std::ranges::find(file_->episodes(), name.id, &EpisodeRow::id);
    if (row == file_->episodes().end()) return {{"problem", "the episode is gone\n"}};
    const Result<LoadedRun> loaded = loader_.Load(*file_, *row, request_.choice);
    if (!loaded) return {{"problem", grammar::Format(loaded.error())}};
    MissingFacts missing;
    const Result<RunResult> run = request_.replay ? Replay(*file_, *row, *loaded)
                                                  : Resegment(*file_, *row, *loaded, &missing);
    if (!run) return {{"problem", grammar::Format(run.error())}};
    Json said = {{"table", RunTable(*run)},
                 {"json", RunJson(loaded->scenario, *run).dump()},
                 {"completed", run->status.kind == physics::RunStatus::Kind::kCompleted},
                 {"finished", row->status != kRecording},
                 {"warnings", grammar::Format(loaded->warnings) + missing.warnings}};
    if (!request_.compare || row->status == kRecording) return said;
    const Result<grammar::Timeline> recorded = file_->TimelineOf(*row);
    if (!recorded) return {{"problem", grammar::Format(recorded.error())}};
    said["differences"] = Differences(*recorded, *run);
    return said;
  }

 private:
  const ResegmentRequest& request_;
  EpisodeLoader loader_;
  std::optional<EpisodeFile> file_;
};

}  // namespace

Result<std::vector<EpisodeName>> SelectEpisodes(const std::vector<std::string>& files,
                                                const std::string& only) {
  std::vector<EpisodeName> names;
  grammar::Diagnostics problems;
  for (const std::string& path : files) {
    const Result<EpisodeFile> file = EpisodeFile::Open(path);
    if (!file) {
      problems.insert(problems.end(), file.error().begin(), file.error().end());
      continue;
    }
    if (file->episodes().empty())
      problems.push_back({.file = path,
                          .place = {},
                          .message = "has no episodes",
                          .source_line = {},
                          .hint = "its recording ended before the first one began"});
    for (const EpisodeRow& row : file->episodes()) {
      if (Matches(row, only)) names.push_back({path, row.id, row.scenario});
    }
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return names;
}

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
                    .completed = one.value("completed", false),
                    .finished = one.value("finished", false)};
    }
  }
  return results;
}

}  // namespace prehend::harness::episodes

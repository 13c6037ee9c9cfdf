// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/export/export_episode.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "harness/base/base/atomic_file.h"
#include "harness/episode/episode/episode.h"
#include "harness/exchange/export/motion.h"

namespace prehend::exchange {
namespace {

/// `file` has one of the endings. Returns "", or what could not be written.
std::string WriteMotion(const Motion& motion, const std::string& file) {
  AtomicFile output(file);
  if (!output.problem().empty()) return output.problem();
  std::filesystem::path beside = file;
  const std::string ending = beside.extension();
  std::string metadata;
  if (ending == ".jsonl") WriteLines(motion, output.stream());
  if (ending == ".npz") WriteNpz(motion, output.stream());
  if (ending == ".csv") WriteCsv(motion, output.stream());
  if (ending == ".mcap") metadata = WriteMcap(motion, beside.filename(), output.stream());
  std::string problem = output.Commit();
  if (problem.empty() && ending != ".jsonl")
    problem = WriteTextFile(file + ".map.yaml", MapText(motion, ending));
  if (problem.empty() && ending == ".csv")
    problem = WriteTextFile(beside.replace_extension(".events.csv"), EventsCsv(motion));
  if (problem.empty() && ending == ".mcap")
    problem = WriteTextFile(beside.replace_filename("metadata.yaml"), metadata);
  return problem;
}

}  // namespace

tl::expected<std::vector<Exported>, episode::NotFound> ExportEpisodes(
    const std::vector<episode::EpisodeName>& episodes, const ExportRequest& request) {
  const bool is_file = request.output.ends_with(request.ending);
  if (is_file && episodes.size() > 1)
    return tl::unexpected(episode::NotFound{
        .message = fmt::format("--output: {} is one file, and {} episodes are selected; name a "
                               "folder, or choose one with --episode",
                               request.output, episodes.size())});
  const bool is_other = !request.choice.grammar.empty() || !request.choice.settings.empty();
  episode::EpisodeOpener opener(request.root);
  std::vector<Exported> all;
  std::map<std::string, int> taken;
  for (const episode::EpisodeName& named : episodes) {
    std::string name = FileNameOf(named.scenario);
    if (name.ends_with(".jsonl")) name.erase(name.size() - 6);
    if (const int before = taken[name]++; before > 0) name += fmt::format("-{}", before + 1);
    if (request.ending == ".mcap") name += "/" + name;  // a bag is a folder
    Exported one{.file = is_file ? request.output : request.output + "/" + name + request.ending};
    Result<episode::Episode> episode = opener.Open(named, request.choice);
    if (!episode) return tl::unexpected(episode::NotFound{.diagnostics = episode.error()});
    const Result<Motion> motion = Motion::Of(*episode, is_other);
    if (!motion) return tl::unexpected(episode::NotFound{.diagnostics = motion.error()});
    if (const std::string problem = WriteMotion(*motion, one.file); !problem.empty())
      return tl::unexpected(episode::NotFound{.exit_code = ExitCode::kFailure, .message = problem});
    one.frames = motion->frames;
    one.events = motion->timeline.events.size();
    one.warnings = episode->missing().warnings;
    if (!motion->failure.empty()) one.failure = named.scenario + ": " + motion->failure;
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace prehend::exchange

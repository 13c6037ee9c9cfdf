// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/labels/read_truths.h. Tested by tests/program/labels_test.cc
#include "harness/exchange/labels/read_truths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>

#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange {
namespace {

namespace fs = std::filesystem;

/// Where the labels of an episode may lie in a folder, without ending.
std::vector<fs::path> StemsOf(const episode::EpisodeName& episode, const fs::path& folder) {
  return {folder / episode.scenario, folder / fs::path(episode.scenario).filename()};
}

/// The file of labels of each episode: as many as there are episodes, in their order; or, where
/// `given` is one folder, the file there with its name: of take1.jsonl take1.csv, take1.eaf, ..; of
/// an episode SKILL/NAME.csv or NAME.csv. "" and `problem` where one is missing.
std::vector<std::string> LabelFilesOf(const std::vector<episode::EpisodeName>& episodes,
                                      const std::vector<std::string>& given, std::string& problem) {
  std::error_code error;
  if (given.size() != 1 || !fs::is_directory(given.front(), error)) {
    if (given.size() != episodes.size())
      problem = fmt::format(
          "{} recordings and {} files of labels; wanted one file for each recording, in the same "
          "order, or a folder",
          episodes.size(), given.size());
    return given;
  }
  std::vector<std::string> files;
  for (const episode::EpisodeName& episode : episodes) {
    std::string found;
    for (const fs::path& stem : StemsOf(episode, given.front())) {
      for (const std::string& ending : LabelEndings()) {
        const std::string file = stem.string() + ending;
        if (found.empty() && fs::exists(file, error)) found = file;
      }
    }
    if (found.empty() && problem.empty())
      problem =
          fmt::format("{} has no labels of '{}': no {} with one of the endings {}", given.front(),
                      episode.scenario, StemsOf(episode, given.front()).back().filename().string(),
                      fmt::join(LabelEndings(), ", "));
    files.push_back(found);
  }
  return files;
}

}  // namespace

Result<LabelReading> ReadTruths(const std::vector<episode::EpisodeName>& episodes,
                                const std::vector<std::string>& given, const std::string& map,
                                const grammar::Program& program, Backward backward) {
  std::string problem;
  const std::vector<std::string> paths = LabelFilesOf(episodes, given, problem);
  if (!problem.empty())
    return tl::unexpected(
        grammar::Diagnostics{{.file = "--truth", .place = {}, .message = problem}});
  const std::vector<grammar::EventSignature> events = grammar::EventSignatures(program);
  std::optional<LabelMap> read;
  if (!map.empty()) {
    Result<LabelMap> meaning = ReadLabelMap(map, events);
    if (!meaning) return tl::unexpected(std::move(meaning.error()));
    read = std::move(*meaning);
  }
  std::vector<LabelFile> files;
  grammar::Diagnostics problems;
  for (const std::string& path : paths) {
    Result<LabelFile> file = ReadLabels(path, read ? read->csv : CsvReading{}, backward);
    if (file)
      files.push_back(std::move(*file));
    else
      problems.insert(problems.end(), file.error().begin(), file.error().end());
    if (problems.size() >= kMostBackward) break;
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return LabelReading::Of(std::move(files), read ? &*read : nullptr, events);
}

std::string BackwardWarning(const LabelReading& reading) {
  std::size_t count = 0;
  std::string files;
  for (const LabelFile& file : reading.files()) {
    if (file.backward == 0) continue;
    count += file.backward;
    files += fmt::format("{}{} of {}", files.empty() ? "" : ", ", file.backward, file.file);
  }
  if (count == 0) return "";
  return count == 1
             ? fmt::format("warning: a label ends before it begins, and is left out: {}\n", files)
             : fmt::format("warning: {} labels end before they begin, and are left out: {}\n",
                           count, files);
}

}  // namespace prehend::exchange

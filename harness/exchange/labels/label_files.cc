// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/labels/label_files.h. Tested by tests/program/labels_test.cc
#include "harness/exchange/labels/label_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "harness/base/base/default_grammar.h"
#include "harness/exchange/labels/read_labels.h"

namespace prehend::exchange {
namespace {

namespace fs = std::filesystem;

/// Where the labels of an episode may lie in a folder, without ending.
std::vector<fs::path> StemsOf(const episode::EpisodeName& episode, const fs::path& folder) {
  return {folder / episode.scenario, folder / fs::path(episode.scenario).filename()};
}

}  // namespace

Result<std::string> OwnGrammar(const std::vector<episode::EpisodeName>& episodes) {
  std::string grammar;
  const episode::EpisodeName* named_by = nullptr;
  for (const episode::EpisodeName& episode : episodes) {
    const std::string own =
        episode.origin == episode::Origin::kRecording ? episode.grammar : kDefaultGrammar;
    if (own.empty()) continue;
    if (named_by && own != grammar)
      return tl::unexpected(grammar::Diagnostics{
          {.file = episode.scenario,
           .place = {},
           .message = fmt::format("it names the grammar {}, and {} the grammar {}", own,
                                  named_by->scenario, grammar),
           .hint = fmt::format("one of them for all: --grammar {}", own)}});
    grammar = own;
    named_by = &episode;
  }
  return grammar.empty() ? kDefaultGrammar : grammar;
}

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

}  // namespace prehend::exchange

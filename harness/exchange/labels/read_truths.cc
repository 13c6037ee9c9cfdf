// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/labels/read_truths.h. Tested by tests/program/labels_test.cc
#include "harness/exchange/labels/read_truths.h"

#include <fmt/format.h>

#include <optional>

namespace prehend::exchange {

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

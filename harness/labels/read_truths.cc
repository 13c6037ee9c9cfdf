// SPDX-License-Identifier: Apache-2.0
// See harness/labels/read_truths.h. Tested by tests/program/labels_test.cc
#include "harness/labels/read_truths.h"

#include <optional>

namespace prehend::harness::labels {

Result<LabelReading> ReadTruths(const std::vector<TakeName>& takes,
                                const std::vector<std::string>& given, const std::string& map,
                                const grammar::Program& program) {
  std::string problem;
  const std::vector<std::string> paths = LabelFilesOf(takes, given, problem);
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
  for (const std::string& path : paths) {
    Result<LabelFile> file = ReadLabels(path, read ? read->csv : CsvReading{});
    if (!file) return tl::unexpected(std::move(file.error()));
    files.push_back(std::move(*file));
  }
  return LabelReading::Of(std::move(files), read ? &*read : nullptr, events);
}

}  // namespace prehend::harness::labels

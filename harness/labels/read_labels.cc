// SPDX-License-Identifier: Apache-2.0
// See harness/labels/read_labels.h. Tested by tests/harness/labels/labels_test.cc
#include "harness/labels/read_labels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "harness/base/csv_cells.h"
#include "harness/base/text_file.h"
#include "harness/golden/golden.h"

namespace prehend::harness::labels {
namespace {

namespace fs = std::filesystem;
using grammar::Diagnostics;
using grammar::Place;

/// The code points of UTF-16 as UTF-8; what is no code point becomes U+FFFD.
std::string FromUtf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<std::uint8_t>(bytes[i]),
               second = static_cast<std::uint8_t>(bytes[i + 1]);
    return static_cast<char32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  std::string text;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    char32_t code = unit(i);
    const bool is_pair = code >= 0xD800 && code < 0xDC00 && i + 3 < bytes.size() &&
                         unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000;
    if (is_pair) {
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    } else if (code >= 0xD800 && code < 0xE000) {
      code = 0xFFFD;
    }
    if (code < 0x80) {
      text += static_cast<char>(code);
    } else if (code < 0x800) {
      text += static_cast<char>(0xC0 | code >> 6);
      text += static_cast<char>(0x80 | (code & 0x3F));
    } else if (code < 0x10000) {
      text += static_cast<char>(0xE0 | code >> 12);
      text += static_cast<char>(0x80 | (code >> 6 & 0x3F));
      text += static_cast<char>(0x80 | (code & 0x3F));
    } else {
      text += static_cast<char>(0xF0 | code >> 18);
      text += static_cast<char>(0x80 | (code >> 12 & 0x3F));
      text += static_cast<char>(0x80 | (code >> 6 & 0x3F));
      text += static_cast<char>(0x80 | (code & 0x3F));
    }
  }
  std::erase(text, '\r');
  return text;
}

/// As ReadTextFile(); Praat also writes UTF-16 with a byte order mark.
Result<std::string> ReadAnyUtf(const std::string& path) {
  char mark[2] = {};
  std::error_code error;
  if (fs::is_regular_file(path, error)) std::ifstream(path, std::ios::binary).read(mark, 2);
  const bool big = mark[0] == '\xFE' && mark[1] == '\xFF',
             little = mark[0] == '\xFF' && mark[1] == '\xFE';
  if ((!big && !little) || fs::file_size(path, error) > kMaxTextFileBytes)
    return ReadTextFile(path);
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::string text = FromUtf16(std::string_view(bytes).substr(2), big);
  Diagnostics strange = CheckText(path, text);
  if (!strange.empty()) return tl::unexpected(std::move(strange));
  return text;
}

std::optional<double> NumberIn(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
    return std::nullopt;
  return number;
}

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// The columns of a file by the words in its first line.
struct CsvColumns {
  std::optional<std::size_t> begin, end, label, tier;
  double begin_unit_s = 1, end_unit_s = 1;

  bool Take(const std::string& word, std::size_t seat) {
    const auto is_one_of = [&](std::initializer_list<const char*> words) {
      return std::ranges::find(words, word) != words.end();
    };
    const double unit_s = word.ends_with("_ms") ? 1e-3 : 1;
    if (is_one_of({"begin", "start", "onset", "begin_s", "start_s", "onset_s", "begin_ms",
                   "start_ms", "onset_ms", "begin_time", "start_time"})) {
      begin = seat;
      begin_unit_s = unit_s;
    } else if (is_one_of({"end", "stop", "offset", "end_s", "stop_s", "offset_s", "end_ms",
                          "stop_ms", "offset_ms", "end_time", "stop_time"})) {
      end = seat;
      end_unit_s = unit_s;
    } else if (is_one_of({"label", "event", "annotation", "text", "action", "value"})) {
      label = seat;
    } else if (is_one_of({"tier", "hand", "track", "layer"})) {
      tier = seat;
    } else {
      return false;
    }
    return true;
  }
};

}  // namespace

grammar::Diagnostic LabelFile::At(Place place, std::string message, std::string hint) const {
  return grammar::DiagnosticAt(file, text, place, std::move(message), std::move(hint));
}

const std::vector<std::string>& LabelEndings() {
  static const std::vector<std::string> endings = {".csv", ".eaf", ".TextGrid", ".timeline"};
  return endings;
}

bool IsLabelFile(const std::string& path) {
  return std::ranges::any_of(LabelEndings(), [&](const std::string& ending) {
    return Lower(path).ends_with(Lower(ending));
  });
}

Result<LabelFile> ReadLabels(const std::string& path) {
  Result<std::string> text = ReadAnyUtf(path);
  if (!text) return tl::unexpected(std::move(text.error()));
  LabelFile file{.file = path, .text = std::move(*text), .labels = {}};
  const std::string ending = Lower(fs::path(path).extension().string());
  Diagnostics problems;
  if (ending == ".csv") {
    problems = ReadCsvLabels(file);
  } else if (ending == ".eaf") {
    problems = ReadEafLabels(file);
  } else if (ending == ".textgrid") {
    problems = ReadTextGridLabels(file);
  } else if (ending == ".timeline") {
    problems = ReadGoldenLabels(file);
  } else {
    problems = {file.At({}, "no file of labels, which end in " +
                                fmt::format("{}", fmt::join(LabelEndings(), ", ")))};
  }
  for (const Label& label : file.labels) {
    if (problems.size() >= kMostComplaints) break;
    if (label.end_s < label.begin_s)
      problems.push_back(
          file.At(label.place, fmt::format("'{}' ends before it begins: {:g} s to {:g} s",
                                           label.text, label.begin_s, label.end_s)));
  }
  if (problems.empty() && file.labels.empty()) problems.push_back(file.At({}, "it has no labels"));
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return file;
}

Diagnostics ReadCsvLabels(LabelFile& file) {
  Diagnostics problems;
  CsvColumns columns;
  std::vector<std::string> words;
  char separator = ',';
  const std::string_view text = file.text;
  int line_number = 0;
  for (std::size_t begin = 0; begin < text.size() && problems.size() < kMostComplaints;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    if (++line_number == 1) {
      for (const char other : {';', '\t'})
        if (line.find(',') == std::string_view::npos && line.find(other) != std::string_view::npos)
          separator = other;
      std::size_t seat = 0;
      for (const CsvCell& cell : CsvCellsOf(line, separator)) {
        words.push_back(std::string(cell.text));
        columns.Take(Lower(cell.text), seat++);
      }
      if (!columns.begin || !columns.end || !columns.label)
        return {
            file.At({1, 1},
                    fmt::format("found the columns {}; wanted one for the begin, the end and "
                                "the label of each row",
                                fmt::join(words, ", ")),
                    "begin_s,end_s,label or begin_ms,end_ms,label; a column 'tier' may follow")};
      continue;
    }
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    const std::vector<CsvCell> cells = CsvCellsOf(line, separator);
    const std::size_t needed = std::max({*columns.begin, *columns.end, *columns.label});
    if (cells.size() <= needed) {
      problems.push_back(file.At(
          {line_number, 1}, fmt::format("found {} cells, wanted {}", cells.size(), words.size())));
      continue;
    }
    const auto seconds = [&](std::size_t seat, double unit_s) -> std::optional<double> {
      const std::optional<double> number = NumberIn(cells[seat].text);
      if (!number)
        problems.push_back(
            file.At({line_number, cells[seat].column},
                    fmt::format("{}: found '{}', wanted a number", words[seat], cells[seat].text)));
      return number ? std::optional(*number * unit_s) : std::nullopt;
    };
    const auto from_s = seconds(*columns.begin, columns.begin_unit_s),
               to_s = seconds(*columns.end, columns.end_unit_s);
    const CsvCell& label = cells[*columns.label];
    if (!from_s || !to_s || label.text.empty()) continue;
    const bool has_tier = columns.tier && *columns.tier < cells.size();
    file.labels.push_back({.begin_s = *from_s,
                           .end_s = *to_s,
                           .text = std::string(label.text),
                           .tier = has_tier ? std::string(cells[*columns.tier].text) : "",
                           .place = {line_number, label.column}});
  }
  return problems;
}

Diagnostics ReadGoldenLabels(LabelFile& file) {
  const Result<Golden> golden = ReadGolden(file.file, file.text);
  if (!golden) return golden.error();
  const auto per_s = static_cast<double>(golden->ticks_per_second);
  for (const GoldenEvent& line : golden->events) {
    file.labels.push_back({.begin_s = static_cast<double>(line.event.interval.begin) / per_s,
                           .end_s = static_cast<double>(line.event.interval.end) / per_s,
                           .text = line.event.Label(),
                           .tier = {},
                           .place = {}});
  }
  return {};
}

}  // namespace prehend::harness::labels

// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/labels/read_labels.h. Tested by tests/harness/exchange/labels/labels_test.cc
#include "harness/exchange/labels/read_labels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <pugixml.hpp>

#include "harness/base/base/csv_cells.h"
#include "harness/base/base/text_file.h"
#include "harness/truth/golden/golden.h"

namespace prehend::exchange {
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
  std::wstring codes;
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
    codes += static_cast<wchar_t>(code);
  }
  std::string text = pugi::as_utf8(codes);
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

/// A number, or seconds after minutes and hours: 1:02:03.5, 02:03.5.
struct TimeCell {
  double number = 0;
  bool is_clock = false;  ///< then in seconds
};
std::optional<TimeCell> TimeIn(std::string_view text) {
  TimeCell time;
  int parts = 0;
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos;
       colon = text.find(':'), ++parts) {
    const std::optional<double> part = NumberIn(text.substr(0, colon));
    if (!part || *part < 0 || *part != std::floor(*part) || parts == 2) return std::nullopt;
    time.number = 60 * (time.number + *part);
    text.remove_prefix(colon + 1);
  }
  time.is_clock = parts > 0;
  const std::optional<double> rest = NumberIn(text);
  if (!rest || (time.is_clock && (*rest < 0 || *rest >= 60))) return std::nullopt;
  time.number += *rest;
  return time;
}

/// A column of times.
struct TimeColumn {
  std::size_t seat = 0;
  double unit_s = 1;
  bool in_frames = false;
};

/// "Start Time" and "start_time" are one name.
std::string Plain(std::string_view word) {
  std::string plain = Lower(word);
  std::ranges::replace(plain, ' ', '_');
  return plain;
}

TimeColumn TimeColumnAt(std::size_t seat, std::string_view word) {
  const std::string plain = Plain(word);
  return {.seat = seat,
          .unit_s = plain.ends_with("_ms") ? 1e-3 : 1,
          .in_frames = plain.ends_with("_frame")};
}

/// The columns of a file by the words in its first line.
struct CsvColumns {
  std::optional<TimeColumn> begin, end;
  std::optional<std::size_t> label, tier;
  std::vector<std::pair<std::string, std::size_t>> roles;

  void Take(std::string_view word, std::size_t seat) {
    const std::string whole = Plain(word);
    std::string_view plain = whole;
    for (const std::string_view unit :
         {"_s", "_sec", "_seconds", "_ms", "_time", "_timestamp", "_frame"}) {
      if (!plain.ends_with(unit)) continue;
      plain.remove_suffix(unit.size());
      break;
    }
    const auto is_one_of = [&](std::initializer_list<const char*> words) {
      return std::ranges::find(words, plain) != words.end();
    };
    const TimeColumn time = TimeColumnAt(seat, word);
    // Of seconds and frames the seconds.
    const auto take = [&](std::optional<TimeColumn>& into) {
      if (!into || into->in_frames || !time.in_frames) into = time;
    };
    if (is_one_of({"begin", "start", "onset"}))
      take(begin);
    else if (is_one_of({"end", "stop", "offset"}))
      take(end);
    else if (is_one_of(
                 {"label", "event", "annotation", "text", "action", "activity", "verb", "value"}))
      label = seat;
    else if (is_one_of({"tier", "hand", "track", "layer"}))
      tier = seat;
  }

  bool IsComplete() const { return begin && end && label; }
  /// Of all columns that are read.
  std::vector<std::size_t> Seats() const {
    std::vector<std::size_t> seats = {begin->seat, end->seat, *label};
    if (tier) seats.push_back(*tier);
    for (const auto& [_, seat] : roles) seats.push_back(seat);
    return seats;
  }
};

/// The columns, or why they cannot be read.
Result<CsvColumns> ColumnsOf(const LabelFile& file, const std::vector<std::string>& words,
                             const CsvReading& how) {
  const auto problem = [&](std::string message, std::string hint) {
    return tl::unexpected(Diagnostics{file.At({1, 1}, std::move(message), std::move(hint))});
  };
  const std::string found = fmt::format("found the columns {}", fmt::join(words, ", "));
  CsvColumns columns;
  for (std::size_t seat = 0; seat < words.size(); ++seat) columns.Take(words[seat], seat);
  std::string missing;
  const auto seat_of = [&](const std::string& name) -> std::optional<std::size_t> {
    const auto at = std::ranges::find(words, name);
    if (at == words.end()) missing = name;
    return at == words.end() ? std::nullopt
                             : std::optional(static_cast<std::size_t>(at - words.begin()));
  };
  const auto name_time = [&](std::optional<TimeColumn>& column, const std::string& name) {
    if (name.empty()) return;
    if (const auto seat = seat_of(name)) column = TimeColumnAt(*seat, name);
  };
  name_time(columns.begin, how.begin);
  name_time(columns.end, how.end);
  if (!how.label.empty()) columns.label = seat_of(how.label);
  if (!how.tier.empty()) columns.tier = seat_of(how.tier);
  for (const grammar::Role& role : how.roles)
    if (const auto seat = seat_of(role.value)) columns.roles.emplace_back(role.name, *seat);
  if (!missing.empty()) {
    const std::string near = grammar::NearestName(missing, words);
    return problem(fmt::format("{}; the map wants a column '{}'", found, missing),
                   near.empty() ? "" : "did you mean '" + near + "'?");
  }
  if (!columns.IsComplete())
    return problem(found + "; wanted one for the begin, the end and the label of each row",
                   "begin_s,end_s,label or begin_ms,end_ms,label, and 'tier' if you like; or name "
                   "yours in the map: columns: {begin: t0, end: t1, label: what}");
  for (const std::size_t seat : columns.Seats())
    if (std::ranges::count(words, words[seat]) > 1)
      return problem(fmt::format("{}: two columns are called '{}'", found, words[seat]), "");
  for (std::optional<TimeColumn>* column : {&columns.begin, &columns.end}) {
    if (how.unit_s > 0 || how.in_frames)
      **column = {.seat = (*column)->seat, .unit_s = how.unit_s, .in_frames = how.in_frames};
    if (!(*column)->in_frames) continue;
    if (how.rate_hz <= 0)
      return problem(fmt::format("'{}' is counted in frames", words[(*column)->seat]),
                     "how many has the video per second? In the map: rate_hz: 30");
    (*column)->unit_s = 1 / how.rate_hz;
  }
  return columns;
}

/// Leaves them out, or says what is wrong with each.
void TakeBackward(LabelFile& file, Backward how, Diagnostics& problems) {
  const auto is_backward = [](const Label& label) { return label.end_s < label.begin_s; };
  if (how == Backward::kSkip) {
    file.backward = std::erase_if(file.labels, is_backward);
    return;
  }
  const auto count = static_cast<std::size_t>(std::ranges::count_if(file.labels, is_backward));
  std::size_t told = 0;
  for (const Label& label : file.labels) {
    if (!is_backward(label) || told == kMostBackward) continue;
    problems.push_back(
        file.At(label.place, fmt::format("'{}' ends before it begins: {:g} s to {:g} s", label.text,
                                         label.begin_s, label.end_s)));
    if (++told < std::min(count, kMostBackward)) continue;
    problems.back().hint = fmt::format(
        "{}--skip-bad-labels leaves out what ends before it begins",
        count > told ? fmt::format("there are {} such labels in the file; ", count) : "");
  }
}

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

Result<LabelFile> ReadLabels(const std::string& path, const CsvReading& csv, Backward backward) {
  Result<std::string> text = ReadAnyUtf(path);
  if (!text) return tl::unexpected(std::move(text.error()));
  LabelFile file{.file = path, .text = std::move(*text), .labels = {}};
  const std::string ending = Lower(fs::path(path).extension().string());
  Diagnostics problems;
  if (ending == ".csv") {
    problems = ReadCsvLabels(file, csv);
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
  TakeBackward(file, backward, problems);
  if (problems.empty() && file.labels.empty()) problems.push_back(file.At({}, "it has no labels"));
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return file;
}

Diagnostics ReadCsvLabels(LabelFile& file, const CsvReading& how) {
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
      for (const CsvCell& cell : CsvCellsOf(line, separator)) words.emplace_back(cell.text);
      Result<CsvColumns> known = ColumnsOf(file, words, how);
      if (!known) return known.error();
      columns = std::move(*known);
      continue;
    }
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    const std::vector<CsvCell> cells = CsvCellsOf(line, separator);
    const auto faulty =
        std::ranges::find_if(cells, [](const CsvCell& cell) { return !cell.fault.empty(); });
    if (faulty != cells.end()) {
      problems.push_back(file.At({line_number, faulty->column},
                                 fmt::format("the cell '{}': {}", faulty->text, faulty->fault)));
      continue;
    }
    if (cells.size() != words.size()) {
      problems.push_back(file.At(
          {line_number, 1}, fmt::format("found {} cells, wanted {}", cells.size(), words.size())));
      continue;
    }
    const auto seconds = [&](const TimeColumn& column) -> std::optional<double> {
      const CsvCell& cell = cells[column.seat];
      const std::optional<TimeCell> time = TimeIn(cell.text);
      if (!time)
        problems.push_back(file.At({line_number, cell.column},
                                   fmt::format("{}: found '{}', wanted a number or a time like "
                                               "0:01:02.5",
                                               words[column.seat], cell.text)));
      return time ? std::optional(time->number * (time->is_clock ? 1 : column.unit_s))
                  : std::nullopt;
    };
    const auto from_s = seconds(*columns.begin), to_s = seconds(*columns.end);
    const CsvCell& label = cells[*columns.label];
    if (!from_s || !to_s || label.text.empty()) continue;
    file.labels.push_back({.begin_s = *from_s,
                           .end_s = *to_s,
                           .text = std::string(label.text),
                           .tier = columns.tier ? std::string(cells[*columns.tier].text) : "",
                           .place = {line_number, label.column},
                           .roles = {}});
    for (const auto& [role, seat] : columns.roles)
      if (!cells[seat].text.empty())
        file.labels.back().roles.push_back({role, std::string(cells[seat].text)});
  }
  return problems;
}

Diagnostics ReadGoldenLabels(LabelFile& file) {
  const Result<truth::Golden> golden = truth::ReadGolden(file.file, file.text);
  if (!golden) return golden.error();
  const auto per_s = static_cast<double>(golden->ticks_per_second);
  for (const truth::GoldenEvent& line : golden->events) {
    file.labels.push_back({.begin_s = static_cast<double>(line.event.interval.begin) / per_s,
                           .end_s = static_cast<double>(line.event.interval.end) / per_s,
                           .text = line.event.Label(),
                           .tier = {},
                           .place = {},
                           .roles = {}});
  }
  return {};
}

}  // namespace prehend::exchange

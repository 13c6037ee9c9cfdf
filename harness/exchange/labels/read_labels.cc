// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/labels/read_labels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <pugixml.hpp>

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

std::string LowerEnding(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
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
  static const std::vector<std::string> endings = {".csv",      ".tsv",      ".eaf",
                                                   ".TextGrid", ".timeline", ".txt"};
  return endings;
}

bool IsLabelFile(const std::string& path) {
  return std::ranges::any_of(LabelEndings(), [&](const std::string& ending) {
    return LowerEnding(path) == LowerEnding("x" + ending);
  });
}

bool IsTable(const std::string& path) {
  const std::string ending = LowerEnding(path);
  return ending == ".csv" || ending == ".tsv";
}

Result<LabelFile> ReadLabels(const std::string& path, const CsvReading& csv, Backward backward) {
  PREHEND_TRY(std::string text, ReadAnyUtf(path));
  LabelFile file{.file = path, .text = std::move(text)};
  const std::string ending = LowerEnding(path);
  Diagnostics problems;
  if (IsTable(path)) {
    problems = ReadCsvLabels(file, csv);
  } else if (ending == ".txt") {
    problems = ReadFrameLabels(file, csv);
  } else if (ending == ".eaf") {
    problems = ReadEafLabels(file);
  } else if (ending == ".textgrid") {
    problems = ReadTextGridLabels(file);
  } else if (ending == ".timeline") {
    problems = ReadGoldenLabels(file);
  } else if (ending == ".jsonl") {
    problems = ReadJsonLabels(file, csv.ticks_per_second);
  } else {
    problems = {file.At({}, "no file of labels, which end in " +
                                fmt::format("{}", fmt::join(LabelEndings(), ", ")))};
  }
  TakeBackward(file, backward, problems);
  // Below a header, or in the tiers, nothing is an answer, too: nothing happened.
  const bool says_nothing = file.has_header && file.empty.empty() && file.backward == 0 &&
                            file.text.find_first_not_of(" \t\n") != std::string::npos;
  if (problems.empty() && file.labels.empty() && !says_nothing)
    problems.push_back(file.At({}, "it has no labels"));
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return file;
}

Diagnostics ReadGoldenLabels(LabelFile& file) {
  PREHEND_TRY(const truth::Golden golden, truth::ReadGolden(file.file, file.text));
  const auto per_s = static_cast<double>(golden.ticks_per_second);
  for (const truth::GoldenEvent& line : golden.events) {
    file.labels.push_back({.begin_s = static_cast<double>(line.event.interval.begin) / per_s,
                           .end_s = static_cast<double>(line.event.interval.end) / per_s,
                           .text = line.event.Label()});
  }
  return {};
}

}  // namespace prehend::exchange

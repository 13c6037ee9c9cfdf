// SPDX-License-Identifier: Apache-2.0
// Numbers, letters and parts of texts, the same in every locale. Tested by
// tests/harness/base/base/number_text_test.cc
#pragma once

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prehend {

/// The number that all of `text` is; none if it is something else, or too large for the type.
template <typename Number>
std::optional<Number> NumberFrom(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// With the letters of ASCII small.
inline std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

/// Without what stands at both ends.
inline std::string_view Trimmed(std::string_view text, std::string_view blanks = " \t\n") {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// What stands between the separators; of "" one part.
template <typename Text = std::string>
std::vector<Text> SplitAt(std::string_view text, char separator) {
  std::vector<Text> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// Without their ends; behind the last line end there is none.
inline std::vector<std::string_view> LinesOf(std::string_view text) {
  std::vector<std::string_view> lines = SplitAt<std::string_view>(text, '\n');
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

/// In double quotes, as YAML and goldens have it.
inline std::string InQuotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

/// Of a file's name, in small letters: ".csv".
inline std::string EndingOf(const std::filesystem::path& path) {
  return LowerCase(path.extension().string());
}

}  // namespace prehend

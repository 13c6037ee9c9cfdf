// SPDX-License-Identifier: Apache-2.0
// Numbers and letters in texts, the same in every locale. Tested by
// tests/harness/base/base/number_text_test.cc
#pragma once

#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

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

/// Of a file's name, in small letters: ".csv".
inline std::string EndingOf(const std::filesystem::path& path) {
  return LowerCase(path.extension().string());
}

}  // namespace prehend

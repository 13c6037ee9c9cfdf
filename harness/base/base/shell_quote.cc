// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/shell_quote.h"

#include <cstdlib>

namespace prehend {

std::string ShellQuoted(std::string_view word) {
  constexpr std::string_view kUnquoted =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,@%+";
  if (!word.empty() && word.find_first_not_of(kUnquoted) == word.npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string ProgramName() {
  const char* const called = std::getenv("PREHEND_COMMAND");
  return called && *called ? ShellQuoted(called) : "prehend";
}

std::string CommandText(const std::vector<std::string>& words) {
  std::string text = ProgramName();
  for (const std::string& word : words) text += " " + ShellQuoted(word);
  return text;
}

}  // namespace prehend

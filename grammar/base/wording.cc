// SPDX-License-Identifier: Apache-2.0
#include "grammar/base/wording.h"

#include <algorithm>
#include <array>

namespace prehend::grammar {
namespace {

bool IsVowel(char c) { return std::string_view("aeiouAEIOU").find(c) != std::string_view::npos; }

}  // namespace

std::string Plural(long long count, std::string_view noun) {
  std::string text(noun);
  if (count == 1 || noun.empty()) return text;
  static constexpr std::array<std::string_view, 5> kHissing = {"s", "x", "z", "ch", "sh"};
  const bool ends_in_y = noun.ends_with('y') && noun.size() > 1 && !IsVowel(noun[noun.size() - 2]);
  if (ends_in_y) return text.substr(0, text.size() - 1) + "ies";
  const bool hisses = std::ranges::any_of(
      kHissing, [&](std::string_view ending) { return noun.ends_with(ending); });
  return text + (hisses ? "es" : "s");
}

std::string WithArticle(std::string_view noun) {
  const bool an = !noun.empty() && (IsVowel(noun.front()) || noun.front() == '8');
  return (an ? "an " : "a ") + std::string(noun);
}

}  // namespace prehend::grammar

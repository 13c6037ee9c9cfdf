// SPDX-License-Identifier: Apache-2.0
// Counts and articles in English, for whatever is said to people.
// Tested by tests/grammar/base/wording_test.cc
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace prehend::grammar {

/// "row" for 1, else "rows", "entries", "faulty lines". The last word has a regular plural.
std::string Plural(long long count, std::string_view noun);

/// "1 row", "3 rows".
template <std::integral Count>
std::string CountOf(Count count, std::string_view noun) {
  return std::to_string(count) + " " + Plural(static_cast<long long>(count), noun);
}

/// "a Thing", "an Object", "an 8 cm cube".
std::string WithArticle(std::string_view noun);

}  // namespace prehend::grammar

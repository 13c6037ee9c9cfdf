// SPDX-License-Identifier: Apache-2.0
// Counts and articles in English, for whatever is said to people.
// Tested by tests/grammar/base/wording_test.cc
#pragma once

#include <string>
#include <string_view>

namespace prehend::grammar {

/// "1 row", "3 rows", "0 entries", "2 faulty lines". The last word of the noun has a regular
/// plural.
std::string CountOf(long long count, std::string_view noun);

/// The noun alone: "row" for 1, else "rows".
std::string Plural(long long count, std::string_view noun);

/// "a Thing", "an Object", "an 8 cm cube".
std::string WithArticle(std::string_view noun);

}  // namespace prehend::grammar

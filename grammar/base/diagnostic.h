// SPDX-License-Identifier: Apache-2.0
// A message about wrong input: where, what was found, what was wanted.
// Shared by the grammar language and by every YAML reader, so that all errors look alike.
// Tested by tests/grammar/base/diagnostic_test.cc
#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::grammar {

/// A place in a text; line and column count from 1, column in bytes. Line 0 means "the file as a
/// whole".
struct Place {
  int line = 0;
  int column = 0;
};

struct Diagnostic {
  std::string file;
  Place place;
  std::string message;  ///< what was found, what was wanted
  std::string
      source_line;  ///< the line at `place`, or what stands around it in a long line; may be empty
  int caret_column = 0;  ///< of `source_line`, counts from 1, in bytes
  std::string hint;      ///< the remedy or the nearest known name; may be empty
  bool is_warning = false;
};

using Diagnostics = std::vector<Diagnostic>;

/// What reads a file stops collecting at so many, so that time and memory are bounded by the size
/// of the file.
inline constexpr std::size_t kMostDiagnostics = 1000;

/// `file:line:column: error: message` (or `warning:`), then the source line and a caret below it
/// (tabs kept), then the hint. Ends with a newline.
std::string Format(const Diagnostic& diagnostic);

/// All of them, one after another.
std::string Format(const Diagnostics& diagnostics);

/// Builds a diagnostic at a place of `text`, filling in the source line. A long line is cut around
/// the place, so that a diagnostic is small.
Diagnostic DiagnosticAt(std::string_view file, std::string_view text, Place place,
                        std::string message, std::string hint = {});

/// Without its end; "" behind the last one.
std::string_view LineOf(std::string_view text, int line);

/// Sets `source_line` and `caret_column`: the line, cut around the column if it is long.
void ShowLine(Diagnostic& diagnostic, std::string_view line, int column);

/// The candidate with the smallest edit distance to `name`, or "" when none is near enough to be
/// worth suggesting (distance above a third of the longer name's length).
std::string NearestName(std::string_view name, const std::vector<std::string>& candidates);

/// "did you mean 'height'?", or `otherwise` when none is near enough.
std::string DidYouMean(std::string_view name, const std::vector<std::string>& candidates,
                       std::string_view otherwise = "");

// Counts and articles in English, for whatever is said to people.
// Tested by tests/grammar/base/wording_test.cc

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

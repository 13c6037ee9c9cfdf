// SPDX-License-Identifier: Apache-2.0
// Layout of a diagnostic as text: the place, the source line with a caret below it, the hint.
#include "grammar/base/diagnostic.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace prehend::grammar {
namespace {

// Longer lines are cut to a window around the caret, so that an error in a one-line 50 MB file
// stays readable.
constexpr std::size_t kMaxShownBytes = 120;
constexpr std::size_t kShownBeforeCaret = 60;

// Bytes that would garble a terminal are shown as '?'. Bytes of UTF-8 sequences stay.
std::string Printable(std::string_view text) {
  std::string shown(text);
  for (char& c : shown) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\t') || byte == 0x7f) c = '?';
  }
  return shown;
}

bool IsContinuationByte(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

// A message is as long as a person reads, whatever a file holds.
std::string Cut(const std::string& message) {
  constexpr std::size_t kMostBytes = 2000;
  if (message.size() <= kMostBytes) return message;
  std::size_t end = kMostBytes;
  while (end > 0 && IsContinuationByte(message[end])) --end;
  return message.substr(0, end) + "... (" + std::to_string(message.size() - end) + " bytes more)";
}

// The source line and the caret line below it. Tabs are repeated, so the caret stands right at any
// tab width.
std::string CaretBlock(std::string_view line, int column) {
  const std::size_t caret = std::min<std::size_t>(column > 0 ? column - 1 : 0, line.size());
  std::string block = "  " + Printable(line) + "\n  ";
  for (const char c : line.substr(0, caret)) {
    if (!IsContinuationByte(c)) block += c == '\t' ? '\t' : ' ';
  }
  return block + "^\n";
}

char Small(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

// Optimal string alignment distance by rows: Levenshtein's, with two swapped neighbours counted as
// one mistake, and capitals as none.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = last[j - 1] + (Small(a[i - 1]) == Small(b[j - 1]) ? 0 : 1);
      row[j] = std::min({substitution, row[j - 1] + 1, last[j] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

/// Small letters, each word without its ending: "pick_up" of "Picking_up".
std::string StemOf(std::string_view name) {
  std::string stem;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('_', begin), name.size());
    std::string word(name.substr(begin, end - begin));
    std::ranges::transform(word, word.begin(), Small);
    for (const std::string_view ending : {"ing", "ed", "es", "e", "s"}) {
      if (word.size() < ending.size() + 3 || !word.ends_with(ending)) continue;
      word.erase(word.size() - ending.size());
      break;
    }
    const std::size_t size = word.size();
    if (size > 3 && word[size - 1] == word[size - 2]) word.pop_back();  // putting, put
    stem += (begin == 0 ? "" : "_") + word;
    begin = end + 1;
  }
  return stem;
}

bool IsVowel(char c) { return std::string_view("aeiouAEIOU").find(c) != std::string_view::npos; }

}  // namespace

std::string_view LineOf(std::string_view text, int line) {
  for (; line > 1 && !text.empty(); --line)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

std::string Format(const Diagnostic& diagnostic) {
  std::string text = diagnostic.file;
  if (diagnostic.place.line > 0) {
    text +=
        ":" + std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column);
  }
  text += (diagnostic.is_warning ? ": warning: " : ": error: ") + Cut(diagnostic.message) + "\n";
  if (!diagnostic.source_line.empty())
    text += CaretBlock(diagnostic.source_line, diagnostic.caret_column);
  if (!diagnostic.hint.empty()) text += "  hint: " + Cut(diagnostic.hint) + "\n";
  return text;
}

std::string Format(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += Format(diagnostic);
  return text;
}

void ShowLine(Diagnostic& diagnostic, std::string_view line, int column) {
  const std::size_t caret = std::min<std::size_t>(column > 0 ? column - 1 : 0, line.size());
  std::size_t first = 0;
  if (line.size() > kMaxShownBytes && caret > kShownBeforeCaret) first = caret - kShownBeforeCaret;
  while (first > 0 && IsContinuationByte(line[first])) --first;
  std::size_t end = std::min(line.size(), first + kMaxShownBytes);
  while (end < line.size() && IsContinuationByte(line[end])) --end;
  const std::string lead = first > 0 ? "..." : "";
  diagnostic.source_line =
      lead + std::string(line.substr(first, end - first)) + (end < line.size() ? "..." : "");
  diagnostic.caret_column = static_cast<int>(lead.size() + caret - first) + 1;
}

Diagnostic DiagnosticAt(std::string_view file, std::string_view text, Place place,
                        std::string message, std::string hint) {
  Diagnostic diagnostic{.file = std::string(file),
                        .place = place,
                        .message = std::move(message),
                        .hint = std::move(hint)};
  if (place.line > 0) ShowLine(diagnostic, LineOf(text, place.line), place.column);
  return diagnostic;
}

std::string NearestName(std::string_view name, const std::vector<std::string>& candidates) {
  // Comparing takes time proportional to both lengths; names of this length are not typed by hand.
  constexpr std::size_t kLongestName = 100;
  if (name.size() > kLongestName) return {};
  std::string best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestName) continue;
    const std::size_t distance = EditDistance(name, candidate);
    if (3 * distance > std::max(name.size(), candidate.size())) continue;
    if (best.empty() || distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (!best.empty()) return best;
  // Else the first one that differs by the endings of its words, as slide and sliding do.
  const std::string stem = StemOf(name);
  const auto related = std::ranges::find(candidates, stem, StemOf);
  return related == candidates.end() || stem.size() < 3 ? "" : *related;
}

std::string DidYouMean(std::string_view name, const std::vector<std::string>& candidates,
                       std::string_view otherwise) {
  const std::string near = NearestName(name, candidates);
  return near.empty() ? std::string(otherwise) : "did you mean '" + near + "'?";
}

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

// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/clauses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace prehend::suite {
namespace {

using Words = std::vector<std::string>;

Words WordsOf(std::string_view text) {
  Words words;
  for (std::size_t begin = 0; (begin = text.find_first_not_of(" \t\r\n", begin)) < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \t\r\n", begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

/// A colour in quotes is none.
std::string_view WithoutComment(std::string_view line) {
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') is_quoted = !is_quoted;
    if (line[i] == '#' && !is_quoted) return line.substr(0, i);
  }
  return line;
}

std::string Joined(const Words& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// A comma is a word, so that a list that goes on has the same last element.
Words PiecesOf(std::string_view text) {
  std::string spaced;
  for (const char c : text) spaced += c == ',' ? std::string(" , ") : std::string(1, c);
  return WordsOf(spaced);
}

/// Commas and connectives at its ends say nothing.
std::string Middle(const Words& words, std::size_t begin, std::size_t end) {
  std::string text = Joined({words.begin() + static_cast<std::ptrdiff_t>(begin),
                             words.begin() + static_cast<std::ptrdiff_t>(end)});
  for (std::size_t at = 0; (at = text.find(" ,")) != std::string::npos;) text.erase(at, 1);
  if (text.ends_with(",")) text.pop_back();
  for (const std::string_view word : {", ", "and ", "or "})
    if (text.starts_with(word)) text.erase(0, word.size());
  return text;
}

std::ptrdiff_t Depth(const Words& words, std::size_t end) {
  std::ptrdiff_t depth = 0;
  for (std::size_t i = 0; i < end; ++i)
    depth += std::ranges::count(words[i], '(') - std::ranges::count(words[i], ')');
  return depth;
}

}  // namespace

std::vector<Clause> ClausesOf(std::string_view grammar) {
  std::vector<Clause> clauses;
  std::map<std::string, int> twins;  // by name, without their numbers
  std::string rule;
  bool is_law = false;
  std::size_t indent = 0;  // of the rule's clauses; 0: none yet
  for (std::size_t begin = 0; begin < grammar.size();) {
    const std::size_t line_end = std::min(grammar.find('\n', begin), grammar.size());
    const std::string_view line = grammar.substr(begin, line_end - begin);
    const std::size_t start = begin;
    begin = line_end + 1;
    const std::string_view said = WithoutComment(line);
    const Words words = WordsOf(said);
    if (words.empty()) continue;
    const std::size_t depth = said.find_first_not_of(" \t");
    const std::size_t end = start + said.find_last_not_of(" \t\r") + 1;
    if (depth == 0) {
      rule.clear();
      if (words.size() > 3 && words[0] == "param")
        clauses.push_back({words[1], Joined({words.begin() + 3, words.end()}), start, end});
      if (words.size() < 2 || words[0] == "param" || words[0] == "use" || words[0] == "grammar")
        continue;
      // "symmetric event contact(..)"
      const auto kind = static_cast<std::ptrdiff_t>(words[0] == "symmetric" && words.size() > 2);
      const std::string& head = words[static_cast<std::size_t>(kind) + 1];
      rule = head.substr(0, head.find('('));
      is_law = words[0] == "law";
      indent = 0;
      ++twins[rule + " roles"];
      clauses.push_back({rule + " roles", Joined({words.begin() + kind + 1, words.end()}),
                         static_cast<std::size_t>(grammar.find(head, start)), end});
    } else if (!rule.empty() && (indent == 0 || (depth <= indent && !is_law))) {
      indent = depth;
      std::string name = rule + " " + (is_law ? "law" : words[0]);
      if (const int twin = ++twins[name]; twin > 1) name += fmt::format(" {}", twin);
      clauses.push_back({std::move(name), Joined(words), start + depth, end});
    } else if (!rule.empty()) {
      clauses.back().text += " " + Joined(words);
      clauses.back().end = end;
    }
  }
  return clauses;
}

std::string WithClause(std::string_view grammar, const std::string& name, const std::string& text) {
  const std::string rule = name.substr(0, name.find(' ') + 1);
  std::size_t begin = std::string::npos, end = 0;
  std::string put = text;
  for (const Clause& clause : ClausesOf(grammar)) {
    if (clause.name == name) {
      begin = clause.begin;
      end = clause.end;
      put = text;
      break;
    }
    // One that is not there any more stands behind the others.
    if (!clause.name.starts_with(rule) || clause.name == rule + "drawn") continue;
    begin = end = clause.end;
    put = "\n  " + text;
  }
  if (begin == std::string::npos) return "";
  return fmt::format("{}{}{}", grammar.substr(0, begin), put, grammar.substr(end));
}

std::string ClauseChangeText(std::string_view before, std::string_view after) {
  const Words old = PiecesOf(before), now = PiecesOf(after);
  const std::size_t most = std::min(old.size(), now.size());
  std::size_t first = 0, last = 0;
  while (first < most && old[first] == now[first]) ++first;
  while (last < most - first && old[old.size() - 1 - last] == now[now.size() - 1 - last]) ++last;
  // What is negated, not only that it is.
  const auto negates = [&](const Words& words) {
    return words.size() == first + last + 1 && words[first] == "not";
  };
  if (last > 0 && (negates(old) || negates(now))) --last;
  // Never from the midst of a call.
  while (first > 0 && (Depth(old, first) > 0 || Depth(now, first) > 0)) --first;
  while (last > 0 && (Depth(old, old.size() - last) > 0 || Depth(now, now.size() - last) > 0))
    --last;
  const std::string was = Middle(old, first, old.size() - last),
                    is = Middle(now, first, now.size() - last);
  if (is.empty()) return fmt::format("lost `{}`", was);
  if (was.empty()) return fmt::format("gained `{}`", is);
  return fmt::format("`{}` -> `{}`", was, is);
}

}  // namespace prehend::suite

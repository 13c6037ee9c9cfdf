// SPDX-License-Identifier: Apache-2.0
#include "harness/base/yaml/diagnostic_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

namespace prehend {

grammar::Diagnostic ErrorAt(const YamlDocument& document, Where where) {
  DiagnosticList one(document);
  one.Add(where, "");
  return one.Sorted().front();
}

void DiagnosticList::Add(Where where, std::string message, std::string hint) {
  if (found_.size() >= grammar::kMostDiagnostics) return;
  const YamlSource& source = document_.sources[static_cast<std::size_t>(where.source)];
  found_.emplace_back(where, grammar::DiagnosticAt(source.name, source.text, where.place,
                                                   std::move(message), std::move(hint)));
}

void DiagnosticList::AddUnknownName(Where where, std::string message, const std::string& name,
                                    const std::vector<std::string>& candidates) {
  if (found_.size() >= grammar::kMostDiagnostics) return;
  constexpr std::size_t kMaxListed = 20;
  const std::string near = grammar::NearestName(name, candidates);
  std::string hint;
  if (!near.empty()) {
    hint = fmt::format("did you mean '{}'?", near);
  } else if (!candidates.empty() && candidates.size() <= kMaxListed) {
    hint = fmt::format("known: {}", fmt::join(candidates, ", "));
  }
  Add(where, std::move(message), std::move(hint));
}

std::optional<std::size_t> DiagnosticList::Find(const Located<std::string>& name,
                                                std::string_view key,
                                                const std::vector<std::string>& known,
                                                std::string_view noun) {
  const auto found = std::ranges::find(known, name.value);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  AddUnknownName(name.where, fmt::format("{}: no {} is called '{}'", key, noun, name.value),
                 name.value, known);
  return std::nullopt;
}

std::string DiagnosticList::PlaceText(Where where) const {
  const YamlSource& source = document_.sources[static_cast<std::size_t>(where.source)];
  return fmt::format("{}:{}:{}", source.name, where.place.line, where.place.column);
}

grammar::Diagnostics DiagnosticList::Sorted() const {
  auto sorted = found_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    const auto key = [](const Where& w) {
      return std::tuple(w.source, w.place.line, w.place.column);
    };
    return key(a.first) < key(b.first);
  });
  grammar::Diagnostics diagnostics;
  for (auto& [where, diagnostic] : sorted) diagnostics.push_back(std::move(diagnostic));
  return diagnostics;
}

}  // namespace prehend

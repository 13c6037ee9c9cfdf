// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>
#include <utility>

#include "harness/scenario/read/read_parts.h"
#include "harness/truth/claims/claim.h"

namespace prehend::scenario {
namespace {

/// What the source has at this place, up to the end of the line.
std::string_view LineFrom(const Where& where, const YamlDocument& document) {
  std::string_view rest = document.sources[static_cast<std::size_t>(where.source)].text;
  for (int line = 1; line < where.place.line; ++line)
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
  rest = rest.substr(0, rest.find('\n'));
  rest.remove_prefix(std::min(static_cast<std::size_t>(where.place.column - 1), rest.size()));
  return rest;
}

/// Finds out where the letters of a claim stand in the file; returns what stands behind them in the
/// line, if that is known.
std::string_view Locate(truth::Claim& claim, const YamlDocument& document) {
  std::string_view line = LineFrom(claim.where, document);
  const bool quoted = line.starts_with('"') || line.starts_with('\'');
  if (quoted) ++claim.where.place.column;
  line.remove_prefix(quoted ? 1 : 0);
  claim.on_one_line = line.starts_with(claim.text);
  return claim.on_one_line ? line.substr(claim.text.size()) : "";
}

bool HasOpenBracket(std::string_view claim) {
  return std::ranges::count(claim, '(') > std::ranges::count(claim, ')');
}

}  // namespace

std::vector<truth::Claim> ReadClaims(const std::vector<Located<std::string>>& written,
                                     const YamlDocument& document, DiagnosticList& errors) {
  std::vector<truth::Claim> claims;
  for (auto text = written.begin(); text != written.end(); ++text) {
    auto parsed = truth::ParseClaim(text->value);
    truth::Claim claim = parsed ? std::move(*parsed) : truth::Claim{.text = text->value};
    claim.where = text->where;
    const std::string_view behind = Locate(claim, document);
    if (parsed) {
      claims.push_back(std::move(claim));
    } else if (HasOpenBracket(claim.text) && behind.starts_with(',')) {
      // In a list in brackets YAML ends a claim at its comma.
      std::string whole = claim.text;
      while (HasOpenBracket(whole) && text + 1 != written.end()) whole += ", " + (++text)->value;
      errors.Add(claim.where, "expects: the comma of a claim ends it in '[..]'",
                 "with quotes: \"" + whole + "\", or one claim per line, each after '- '");
    } else {
      errors.Add(truth::PlaceIn(claim, parsed.error().offset), "expects: " + parsed.error().message,
                 parsed.error().hint);
    }
  }
  return claims;
}

}  // namespace prehend::scenario

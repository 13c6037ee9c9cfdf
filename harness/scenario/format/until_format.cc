// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

constexpr const char* kConditions =
    "'touching(milk)' or 'gap(milk) < 5 mm', perhaps with ', or go on'";

/// What a condition says, as far as it says it.
struct SaidUntil {
  std::string word, who, thing;
  std::optional<double> number;  ///< of "< 5 mm"
  std::string_view rest;         ///< what follows the number
};

SaidUntil SaidBy(std::string_view text) {
  SaidUntil said;
  const std::size_t open = text.find('('), close = text.find(')');
  if (open == std::string::npos || close == std::string::npos || close < open) return said;
  said.word = text.substr(0, open);
  said.thing = text.substr(open + 1, close - open - 1);
  if (const std::size_t comma = said.thing.find(", "); comma != std::string::npos) {
    said.who = said.thing.substr(0, comma);
    said.thing.erase(0, comma + 2);
  }
  const std::size_t digits = text.find_first_of("0123456789", text.find('<', close));
  if (digits == std::string::npos) return said;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + digits, end, said.number.emplace());
  said.rest = {read.ptr, static_cast<std::size_t>(end - read.ptr)};
  return said;
}

/// How one that cannot be read was meant; "" if it can be read, or that is not known.
std::string Remedy(const SaidUntil& said) {
  if (said.word != "touching" && said.word.starts_with("touch"))
    return fmt::format("write: touching({})", said.thing);
  const bool has_unit = !said.rest.empty() && !said.rest.starts_with(',');
  if (said.word != "gap" || !said.number || has_unit) return "";
  // Who leaves the unit out thinks of millimetres, or of metres as elsewhere in the file.
  return fmt::format("a length has a unit: gap({}) < {} mm", said.thing,
                     *said.number < 1 ? 1000 * *said.number : *said.number);
}

}  // namespace

ValueFormat<physics::Until> UntilFormat() {
  const auto condition = Word(
      "(touching\\(([a-z][a-z0-9_]*, )?[a-z][a-z0-9_]*\\)|gap\\(([a-z][a-z0-9_]*, "
      ")?[a-z][a-z0-9_]*\\) "
      "< [0-9]+(\\.[0-9]+)? (mm|cm|m))(, or go on)?",
      kConditions, 120);
  const auto read = [condition](const YamlNode& node, DiagnosticList& errors,
                                physics::Until& until) {
    const SaidUntil said =
        SaidBy(node.kind == YamlNode::Kind::kScalar ? std::string_view(node.text) : "");
    if (const std::string remedy = Remedy(said); !remedy.empty()) {
      errors.Add(node.where, fmt::format("until: expected {}, found '{}'", kConditions, node.text),
                 remedy);
      return false;
    }
    std::string text;
    if (!condition.Read(node, errors, text)) return false;
    until = {
        .thing = said.thing, .gap_m = {}, .or_go_on = text.ends_with("or go on"), .who = said.who};
    if (said.number)
      until.gap_m = *said.number * (said.rest.starts_with(" mm")   ? 0.001
                                    : said.rest.starts_with(" cm") ? 0.01
                                                                   : 1);
    return true;
  };
  return ValueFormat<physics::Until>(condition.schema(), read);
}

}  // namespace prehend::scenario

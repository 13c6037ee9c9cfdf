// SPDX-License-Identifier: Apache-2.0
// See harness/cli/command/options.h. Tested by tests/harness/cli/command/parse_arguments_test.cc
#include "harness/cli/command/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <utility>

namespace prehend::cli {
namespace {

/// The number that all of `text` is; nothing when it is none, or too large for the type.
template <typename Number>
std::optional<Number> NumberFrom(const std::string& text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

template <typename Number>
ValueRule RuleFor(const char* what, Number least, Number most) {
  const std::string range = fmt::format("{} to {}", least, most);
  return {.range = range, .problem = [=](const std::string& value) {
            const auto number = NumberFrom<Number>(value);
            // A comparison with nan is false: it is refused, too.
            if (number && *number >= least && *number <= most) return std::string();
            return fmt::format("found '{}', wanted {} from {}", value, what, range);
          }};
}

}  // namespace

ValueRule IntegersFrom(std::int64_t least, std::int64_t most) {
  return RuleFor("a whole number", least, most);
}

ValueRule NumbersFrom(double least, double most) { return RuleFor("a number", least, most); }

std::vector<Option> InGroup(const std::string& group, std::vector<Option> options) {
  for (Option& option : options) option.group = group;
  return options;
}

Option Required(Option option) {
  option.required = true;
  return option;
}

std::vector<Option> Joined(std::vector<Option> first, std::vector<Option> second) {
  std::ranges::move(second, std::back_inserter(first));
  return first;
}

ParsedOptions::ParsedOptions(std::map<std::string, std::vector<std::string>> values)
    : values_(std::move(values)) {}

std::string ParsedOptions::TextOr(const std::string& name, const std::string& fallback) const {
  return Has(name) ? All(name).back() : fallback;
}

int ParsedOptions::IntOr(const std::string& name, int fallback) const {
  return Has(name) ? NumberFrom<int>(All(name).back()).value() : fallback;
}

std::uint64_t ParsedOptions::UnsignedOr(const std::string& name, std::uint64_t fallback) const {
  return Has(name) ? NumberFrom<std::uint64_t>(All(name).back()).value() : fallback;
}

double ParsedOptions::NumberOr(const std::string& name, double fallback) const {
  return Has(name) ? NumberFrom<double>(All(name).back()).value() : fallback;
}

}  // namespace prehend::cli

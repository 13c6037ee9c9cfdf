// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/arrays/json_path.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/exchange/cells/table_cells.h"

namespace prehend::exchange {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostNames = 50;  ///< in an error
constexpr std::string_view kBlanks = " \t";

std::string_view Trimmed(std::string_view text, std::string_view of) {
  const std::size_t begin = std::min(text.find_first_not_of(of), text.size());
  return text.substr(begin, text.find_last_not_of(of) + 1 - begin);
}

bool IsQuoted(std::string_view text) {
  return text.size() > 1 && (text.front() == '\'' || text.front() == '"') &&
         text.back() == text.front();
}

/// What stands between brackets.
std::optional<JsonStep> StepInBrackets(std::string_view text) {
  text = Trimmed(text, kBlanks);
  if (text == "*") return JsonStep{.kind = JsonStep::Kind::kAll, .key = {}, .value = {}};
  if (IsQuoted(text)) return JsonStep{.key = std::string(text.substr(1, text.size() - 2))};
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && end == text.data() + text.size())
    return JsonStep{.kind = JsonStep::Kind::kIndex, .key = {}, .value = {}, .index = index};
  // [type=right], and as JSONPath has it: [?(@.type == 'right')]
  if (text.starts_with('?')) text = Trimmed(text.substr(1), kBlanks);
  if (text.starts_with('(') && text.ends_with(')')) text = text.substr(1, text.size() - 2);
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  std::string_view key = Trimmed(text.substr(0, equals), kBlanks);
  if (key.starts_with("@.")) key.remove_prefix(2);
  std::string_view value = Trimmed(text.substr(equals), "= \t");
  if (IsQuoted(value)) value = value.substr(1, value.size() - 2);
  if (key.empty() || value.empty()) return std::nullopt;
  return JsonStep{
      .kind = JsonStep::Kind::kMatch, .key = std::string(key), .value = std::string(value)};
}

/// The bracket that closes the first one, not one in quotes.
std::size_t EndOfBracket(std::string_view text) {
  char quote = 0;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (quote != 0)
      quote = text[i] == quote ? '\0' : quote;
    else if (text[i] == '\'' || text[i] == '"')
      quote = text[i];
    else if (text[i] == ']')
      return i;
  }
  return std::string_view::npos;
}

std::string TextOf(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

bool Matches(const Json& value, const JsonStep& step, JsonMiss& miss) {
  if (!value.is_object()) return false;
  const auto member = value.find(step.key);
  if (member == value.end()) return false;
  const std::string text = TextOf(*member);
  if (text != step.value && miss.names.size() < kMostNames &&
      std::ranges::count(miss.names, text) == 0)
    miss.names.push_back(text);
  return text == step.value;
}

/// Of a member of `value`, or null.
const Json* Follow(const Json& value, const JsonStep& step, JsonMiss& miss) {
  miss.names.clear();
  miss.name = step.kind == JsonStep::Kind::kMatch ? step.value : step.key;
  if (step.kind == JsonStep::Kind::kKey) {
    if (!value.is_object()) return nullptr;
    const auto found = value.find(step.key);
    if (found != value.end()) return &*found;
    for (const auto& [key, member] : value.items())
      if (miss.names.size() < kMostNames) miss.names.push_back(key);
  } else if (step.kind == JsonStep::Kind::kIndex) {
    miss.name = std::to_string(step.index);
    if (value.is_array() && step.index < value.size()) return &value[step.index];
  } else if (step.kind == JsonStep::Kind::kMatch) {
    if (Matches(value, step, miss)) return &value;
    if (value.is_array())
      for (const Json& one : value)
        if (Matches(one, step, miss)) return &one;
  }
  return nullptr;
}

/// "(0.1, -2, 3)"
bool NumbersOfText(const std::string& text, std::vector<double>& numbers) {
  std::string_view left = Trimmed(text, "()[] \t");
  while (!left.empty()) {
    const std::size_t end = std::min(left.find_first_of(", \t"), left.size());
    const auto number = NumberOf(left.substr(0, end), false);
    if (!number) return false;
    numbers.push_back(*number);
    left.remove_prefix(std::min(left.find_first_not_of(", \t", end), left.size()));
  }
  return !text.empty();
}

bool NumbersOfObject(const Json& value, std::vector<double>& numbers, bool& by_name) {
  std::map<std::string, const Json*> members;
  bool is_matrix = value.size() == 9 || value.size() == 16;
  for (const auto& [key, member] : value.items()) {
    std::string name = key;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    is_matrix = is_matrix && name.size() == 3 &&
                std::isdigit(static_cast<unsigned char>(name[1])) &&
                std::isdigit(static_cast<unsigned char>(name[2]));
    members.emplace(std::move(name), &member);
  }
  std::vector<std::string> wanted;
  if (is_matrix)
    for (const auto& [name, member] : members) wanted.push_back(name);
  else
    wanted = members.contains("w") ? std::vector<std::string>{"x", "y", "z", "w"}
                                   : std::vector<std::string>{"x", "y", "z"};
  by_name = wanted.size() == 4;
  for (const std::string& name : wanted) {
    const auto member = members.find(name);
    if (member == members.end() || !(member->second->is_number() || member->second->is_null()))
      return false;
    bool ignored = false;
    NumbersOfJson(*member->second, numbers, ignored);
  }
  return true;
}

}  // namespace

std::optional<JsonPath> ParseJsonPath(std::string_view text) {
  JsonPath path;
  const bool whole = text == "$" || text == "@";
  if (text.starts_with('$') || text.starts_with('@')) text.remove_prefix(1);
  bool first = true;
  while (!text.empty()) {
    if (text.starts_with('[')) {
      const std::size_t end = EndOfBracket(text);
      if (end == std::string_view::npos) return std::nullopt;
      auto step = StepInBrackets(text.substr(1, end - 1));
      if (!step) return std::nullopt;
      path.push_back(std::move(*step));
      text.remove_prefix(end + 1);
    } else {
      if (!first && !text.starts_with('.')) return std::nullopt;
      if (text.starts_with('.')) text.remove_prefix(1);
      const std::size_t end = std::min(text.find_first_of(".["), text.size());
      if (end == 0) return std::nullopt;
      if (text.substr(0, end) == "*")
        path.push_back({.kind = JsonStep::Kind::kAll, .key = {}, .value = {}});
      else
        path.push_back({.key = std::string(text.substr(0, end)), .value = {}});
      text.remove_prefix(end);
    }
    first = false;
  }
  if (path.empty() && !whole) return std::nullopt;
  return path;
}

std::vector<std::string> WithoutBraces(const std::string& text) {
  const std::size_t open = text.find('{'), close = text.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {text};
  std::vector<std::string> all;
  for (std::size_t at = open + 1; at <= close;) {
    const std::size_t end = std::min(text.find(',', at), close);
    all.push_back(text.substr(0, open) +
                  std::string(Trimmed(std::string_view(text).substr(at, end - at), kBlanks)) +
                  text.substr(close + 1));
    at = end + 1;
  }
  return all;
}

const Json* FindInJson(const Json& root, const JsonPath& path, JsonMiss& miss) {
  const Json* at = &root;
  for (miss.steps = 0; miss.steps < path.size(); ++miss.steps) {
    if (at->is_null()) return nullptr;
    at = Follow(*at, path[miss.steps], miss);
    if (!at) return nullptr;
  }
  return at;
}

bool NumbersOfJson(const Json& value, std::vector<double>& numbers, bool& by_name) {
  if (value.is_number()) {
    numbers.push_back(value.get<double>());
  } else if (value.is_boolean()) {
    numbers.push_back(value.get<bool>() ? 1 : 0);
  } else if (value.is_null()) {
    numbers.push_back(std::numeric_limits<double>::quiet_NaN());
  } else if (value.is_string()) {
    return NumbersOfText(value.get_ref<const std::string&>(), numbers);
  } else if (value.is_array()) {
    for (const Json& one : value)
      if (!NumbersOfJson(one, numbers, by_name)) return false;
  } else {
    return NumbersOfObject(value, numbers, by_name);
  }
  return true;
}

}  // namespace prehend::exchange

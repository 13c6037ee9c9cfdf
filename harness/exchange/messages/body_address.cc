// SPDX-License-Identifier: Apache-2.0
// See harness/exchange/messages/body_address.h. Tested by
// tests/harness/exchange/messages/pose_fields_test.cc
#include "harness/exchange/messages/body_address.h"

#include <algorithm>

namespace prehend::exchange {
namespace {

/// "[Cup]" at the beginning of the text, which it takes away; brackets in names are in pairs.
std::optional<std::string> TakeKey(std::string_view& text) {
  int open = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    open += text[i] == '[' ? 1 : text[i] == ']' ? -1 : 0;
    if (open > 0) continue;
    std::string key(text.substr(1, i - 1));
    text.remove_prefix(i + 1);
    return key;
  }
  return std::nullopt;
}

bool IsMeant(const BodyAddress& address, const PoseField& field) {
  if (address.keys.size() != field.Lists()) return false;
  return address.steps.size() <= field.steps.size() &&
         std::equal(address.steps.begin(), address.steps.end(), field.steps.begin());
}

}  // namespace

std::optional<BodyAddress> ParseBodyAddress(std::string_view text) {
  BodyAddress address;
  const bool has_path = text.starts_with(':');
  while (!text.empty()) {
    if (has_path) {
      if (text[0] != (address.steps.empty() ? ':' : '.')) return std::nullopt;
      text.remove_prefix(1);
      const std::size_t end = std::min(text.find_first_of(".["), text.size());
      if (end == 0) return std::nullopt;
      address.steps.push_back({.field = std::string(text.substr(0, end))});
      text.remove_prefix(end);
    }
    if (text.starts_with('[')) {
      std::optional<std::string> key = TakeKey(text);
      if (!key) return std::nullopt;
      address.keys.push_back(std::move(*key));
      if (has_path) address.steps.back().list = true;
    } else if (!has_path) {
      return std::nullopt;
    }
  }
  return address;
}

std::vector<std::size_t> FieldsOf(const BodyAddress& address,
                                  const std::vector<PoseField>& fields) {
  std::vector<std::size_t> meant;
  bool oriented = false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!IsMeant(address, fields[i])) continue;
    if (address.steps.size() == fields[i].steps.size()) return {i};  // its whole path
    meant.push_back(i);
    oriented = oriented || fields[i].oriented;
  }
  if (oriented) std::erase_if(meant, [&](std::size_t i) { return !fields[i].oriented; });
  return meant;
}

std::string AddressOf(const std::string& topic, const std::vector<PoseField>& fields,
                      std::size_t field, const std::vector<std::string>& keys) {
  BodyAddress address{.steps = {}, .keys = keys};
  const std::vector<PoseField::Step>& steps = fields[field].steps;
  const std::vector<std::size_t> only = {field};
  // With a path, all lists are in it.
  const auto is_complete = [&] {
    const auto lists = std::ranges::count(address.steps, true, &PoseField::Step::list);
    const bool has_lists = address.steps.empty() || static_cast<std::size_t>(lists) == keys.size();
    return has_lists && FieldsOf(address, fields) == only;
  };
  while (!is_complete() && address.steps.size() < steps.size())
    address.steps.push_back(steps[address.steps.size()]);
  std::string text = topic;
  auto key = keys.begin();
  for (std::size_t i = 0; i < address.steps.size(); ++i) {
    text += (i == 0 ? ":" : ".") + address.steps[i].field;
    if (address.steps[i].list && key != keys.end()) text += "[" + *key++ + "]";
  }
  for (; key != keys.end(); ++key) text += "[" + *key + "]";
  return text;
}

}  // namespace prehend::exchange

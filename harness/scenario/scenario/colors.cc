// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/scenario/colors.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace prehend::scenario {
namespace {

struct NamedColor {
  std::string_view name;
  std::uint32_t rgb;
};

// Words name hues as people use them; lightnesses differ, so that two of them stay apart without
// colour, too.
constexpr std::array<NamedColor, 19> kWords = {{
    {"white", 0xF1F3F4},  {"black", 0x2B2D30},  {"grey", 0x8D949B},      {"gray", 0x8D949B},
    {"silver", 0xC3C9CE}, {"steel", 0xA7B0B8},  {"red", 0xC62828},       {"orange", 0xE8871E},
    {"yellow", 0xF2C71B}, {"green", 0x4CA64C},  {"blue", 0x2F6FC4},      {"purple", 0x7B4AA8},
    {"violet", 0x7B4AA8}, {"pink", 0xE79AB8},   {"brown", 0x7A5230},     {"beige", 0xDCC9A3},
    {"wooden", 0xC8A27C}, {"golden", 0xCFA23A}, {"turquoise", 0x36B5AC},
}};

constexpr std::array<NamedColor, 25> kClasses = {{
    {"MilkCarton", 0xE9F0F6}, {"JuiceCarton", 0xE8871E}, {"Carton", 0xC99C63},
    {"Box", 0xC99C63},        {"Crate", 0xB98A55},       {"Can", 0xA7B0B8},
    {"Cup", 0x3F7FB5},        {"Mug", 0x3F7FB5},         {"Bowl", 0xD9E2DC},
    {"Plate", 0xEEF1F0},      {"Tray", 0x6D7B86},        {"Pot", 0x5A636B},
    {"Jar", 0xB8D0CC},        {"Glass", 0xBFE0EA},       {"Bottle", 0x5E9C76},
    {"Spoon", 0xB9C1C7},      {"Table", 0xC8A27C},       {"SideTable", 0xB98F66},
    {"Cupboard", 0xB98F66},   {"Cabinet", 0xB98F66},     {"Drawer", 0xD9B98F},
    {"Door", 0xD9B98F},       {"Handle", 0x5A636B},      {"Egg", 0xF3E3C8},
    {"Soap", 0xE9B8C8},
}};

template <std::size_t kCount>
std::optional<std::uint32_t> Find(const std::array<NamedColor, kCount>& colors,
                                  std::string_view name) {
  const auto found = std::ranges::find(colors, name, &NamedColor::name);
  if (found == colors.end()) return std::nullopt;
  return found->rgb;
}

}  // namespace

const std::vector<std::string>& ColorWords() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all;
    for (const NamedColor& color : kWords) all.emplace_back(color.name);
    return all;
  }();
  return words;
}

std::optional<std::uint32_t> ColorOfText(std::string_view text) {
  if (!text.starts_with('#')) return Find(kWords, text);
  std::uint32_t rgb = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, rgb, 16);
  if (text.size() != 7 || stop != end || error != std::errc()) return std::nullopt;
  return rgb;
}

std::optional<std::uint32_t> ColorInName(std::string_view name) {
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('_'), name.size());
    if (const auto color = Find(kWords, name.substr(0, end))) return color;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return std::nullopt;
}

std::optional<std::uint32_t> ColorOfClass(std::string_view class_name) {
  return Find(kClasses, class_name);
}

}  // namespace prehend::scenario

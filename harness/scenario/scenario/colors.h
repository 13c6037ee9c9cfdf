// SPDX-License-Identifier: Apache-2.0
// Colours of things in pictures, 0xRRGGBB: by a word ("blue"), by a word in a name (`blue_cup`), or
// by class. Tested by tests/harness/scenario/scenario/colors_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::scenario {

/// The words that `color:` accepts.
const std::vector<std::string>& ColorWords();

/// Of a word, or of "#RRGGBB"; no value for anything else.
std::optional<std::uint32_t> ColorOfText(std::string_view text);

/// Of the first colour word among the parts of a name that are joined by underscores.
std::optional<std::uint32_t> ColorInName(std::string_view name);

/// What things of a class usually look like: cartons are white, cans steel.
std::optional<std::uint32_t> ColorOfClass(std::string_view class_name);

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// Options that are numbers with a fraction. Tested by tests/program/command_line_test.cc
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>

namespace prehend::harness {

/// Like CLI::Range, which lets through what is not a number.
inline CLI::Validator NumberIn(double least, double most) {
  const CLI::Validator range = CLI::Range(least, most);
  return CLI::Validator(
      [range](std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && std::isnan(value))
          return "Value " + text + " is no number";
        return range(text);
      },
      range.get_description());
}

}  // namespace prehend::harness

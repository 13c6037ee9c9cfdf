// SPDX-License-Identifier: Apache-2.0
// What a plain YAML scalar means, when all YAML versions agree about it. YAML 1.1 and 1.2 read
// `no`, `010`, `1:30` or `1_000` differently, so these are refused wherever a value is expected,
// with a hint how to write what is meant. Tested by tests/harness/base/yaml/yaml_scalar_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "harness/base/yaml/located_yaml.h"

namespace prehend {

/// The largest magnitude that `vary:` and `--set` may write.
inline constexpr double kMaxNumber = 1e6;

/// Exactly one of: a number, true/false, a string, or ambiguous (with the reason).
struct ScalarMeaning {
  std::optional<double> number;
  bool integer = false;  ///< the number is written without point and exponent
  std::optional<bool> flag;
  std::optional<std::string> string;
  std::string ambiguous;  ///< e.g. "a leading zero means octal to some YAML readers"
  std::string remedy;     ///< e.g. "write 10, or '010' in quotes for text"
};

/// The node is a scalar.
ScalarMeaning MeaningOf(const YamlNode& node);

/// The number that is written there, if it is one and no larger than kMaxNumber.
std::optional<double> NumberOf(const YamlNode& node);

/// How messages describe a node: "'heavy'", "a list", "a mapping", "nothing".
std::string Describe(const YamlNode& node);

/// A hint about characters that resemble ASCII ones, as word processors insert them; or "".
std::string LookAlikeRemedy(std::string_view text);

}  // namespace prehend

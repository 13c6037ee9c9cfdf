// SPDX-License-Identifier: Apache-2.0
// JSON as the same tree that YAML becomes (harness/base/yaml/located_yaml.h), so that one field
// table reads both: every key and value knows its place. Strict JSON (RFC 8259): no comments, no
// bare words. Duplicate keys and deep nesting are refused, too. Tested by
// tests/harness/base/yaml/located_json_test.cc
#pragma once

#include <string>

#include "harness/base/yaml/located_yaml.h"

namespace prehend {

/// Parses `text`, one JSON value, after CheckText(). Of a number, `text` of its node is as it is
/// spelled. On failure: diagnostics with places in `file`; line 1 is the first line of `text`.
Result<YamlDocument> ParseJson(const std::string& file, std::string text);

}  // namespace prehend

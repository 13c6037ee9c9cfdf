// SPDX-License-Identifier: Apache-2.0
// A place of a document, for an error that is found later. Tested by tests/program/import_test.cc
#pragma once

#include "harness/base/yaml/located_yaml.h"

namespace prehend {

/// An error at this place that says nothing yet.
grammar::Diagnostic ErrorAt(const YamlDocument& document, Where where);

}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// See harness/base/yaml/error_at.h. Tested by tests/program/import_test.cc
#include "harness/base/yaml/error_at.h"

#include "harness/base/yaml/diagnostic_list.h"

namespace prehend {

grammar::Diagnostic ErrorAt(const YamlDocument& document, Where where) {
  DiagnosticList one(document);
  one.Add(where, "");
  return one.Sorted().front();
}

}  // namespace prehend

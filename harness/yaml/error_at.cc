// SPDX-License-Identifier: Apache-2.0
// See harness/yaml/error_at.h. Tested by tests/program/import_test.cc
#include "harness/yaml/error_at.h"

#include "harness/yaml/diagnostic_list.h"

namespace prehend::harness {

grammar::Diagnostic ErrorAt(const YamlDocument& document, Where where) {
  DiagnosticList one(document);
  one.Add(where, "");
  return one.Sorted().front();
}

}  // namespace prehend::harness

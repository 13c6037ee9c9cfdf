// SPDX-License-Identifier: Apache-2.0
#include "harness/base/yaml/error_at.h"

#include "harness/base/yaml/diagnostic_list.h"

namespace prehend {

grammar::Diagnostic ErrorAt(const YamlDocument& document, Where where) {
  DiagnosticList one(document);
  one.Add(where, "");
  return one.Sorted().front();
}

}  // namespace prehend

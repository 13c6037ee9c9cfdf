// SPDX-License-Identifier: Apache-2.0
// Collects the errors of one document while it is read, in any order, and returns them sorted by
// place. Tested by tests/harness/base/yaml/struct_format_test.cc
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/yaml/located_yaml.h"

namespace prehend {

/// Keeps the first grammar::kMostDiagnostics that are added.
class DiagnosticList {
 public:
  /// The document outlives this object.
  explicit DiagnosticList(const YamlDocument& document) : document_(document) {}

  void Add(Where where, std::string message, std::string hint = {});
  /// For example "did you mean 'mass_kg'?", or the list of candidates when nothing is near.
  void AddUnknownName(Where where, std::string message, const std::string& name,
                      const std::vector<std::string>& candidates);

  /// Where the name is among those known; else there is none, and an error: "KEY: no NOUN is called
  /// 'NAME'".
  std::optional<std::size_t> Find(const Located<std::string>& name, std::string_view key,
                                  const std::vector<std::string>& known,
                                  std::string_view noun = "entity");

  /// "FILE:LINE:COLUMN", for what is found out only when the scenario runs.
  std::string PlaceText(Where where) const;

  bool empty() const { return found_.empty(); }
  /// Sorted by place; errors at the same place in the order they were added.
  grammar::Diagnostics Sorted() const;

 private:
  const YamlDocument& document_;
  std::vector<std::pair<Where, grammar::Diagnostic>> found_;
};

// A place of a document, for an error that is found later. Tested by tests/program/import_test.cc

/// An error at this place that says nothing yet.
grammar::Diagnostic ErrorAt(const YamlDocument& document, Where where);

}  // namespace prehend

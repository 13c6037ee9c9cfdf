// SPDX-License-Identifier: Apache-2.0
// An independent validator of YAML files against a JSON Schema: python3-jsonschema and
// python3-yaml.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace prehend::scenario {

class PythonValidator {
 public:
  PythonValidator();
  ~PythonValidator();
  PythonValidator(const PythonValidator&) = delete;
  PythonValidator& operator=(const PythonValidator&) = delete;

  void Add(const std::string& name, const std::string& yaml);
  /// Which texts are valid, by name. Empty when the validator could not run.
  std::map<std::string, bool> Validate(const std::string& schema) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
};

}  // namespace prehend::scenario

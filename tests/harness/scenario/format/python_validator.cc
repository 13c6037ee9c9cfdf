// SPDX-License-Identifier: Apache-2.0
#include "tests/harness/scenario/format/python_validator.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace prehend::scenario {

PythonValidator::PythonValidator()
    : folder_(std::filesystem::path(testing::TempDir()) / ("schema_" + std::to_string(getpid()))) {
  std::filesystem::create_directories(folder_);
}

PythonValidator::~PythonValidator() { std::filesystem::remove_all(folder_); }

void PythonValidator::Add(const std::string& name, const std::string& yaml) {
  std::ofstream(folder_ / name) << yaml;
  names_.push_back(name);
}

std::map<std::string, bool> PythonValidator::Validate(const std::string& schema) const {
  std::ofstream(folder_ / "schema.json") << schema;
  std::string command = "cd '" + folder_.string() +
                        "' && /usr/bin/python3 " PREHEND_SOURCE_DIR
                        "/tests/harness/validate_against_schema.py schema.json";
  for (const std::string& name : names_) command += " " + name;
  if (std::system((command + " > result").c_str()) != 0) return {};
  std::map<std::string, bool> valid;
  std::ifstream result(folder_ / "result");
  for (std::string line; std::getline(result, line);) {
    const auto colon = line.find(": ");
    valid[line.substr(0, colon)] = line.substr(colon + 2) == "valid";
  }
  return valid;
}

}  // namespace prehend::scenario

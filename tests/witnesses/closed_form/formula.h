// SPDX-License-Identifier: Apache-2.0
// Formulas in files: numbers, names, + - * / ^, comparisons, && and ||, `a ? b : c`, and functions.
// muParser reads and computes them. Tested by tests/witnesses/closed_form/formula_test.cc
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace mu {
class Parser;
}

namespace prehend::witnesses {

/// What is wrong with a formula.
struct FormulaError {
  std::string message;
  int offset = 0;       ///< in bytes, from the begin of the formula
  std::string unknown;  ///< the name that is not known, if that is what is wrong
};

/// A formula that was read; it computes with the present values of its scope's variables.
class Formula {
 public:
  explicit Formula(std::shared_ptr<const mu::Parser> parser) : parser_(std::move(parser)) {}
  double Value() const;

 private:
  std::shared_ptr<const mu::Parser> parser_;
};

/// The names that a formula may use. A copy shares the variables that its original had.
/// Functions, besides those of muParser (sqrt, sin, min, ..): ramp(t, from, to) is 0 before `from`,
/// 1 after `to` and straight between; mod(a, b) is the remainder of a / b, from 0 to b.
class FormulaScope {
 public:
  FormulaScope();

  bool Knows(const std::string& name) const;
  /// Names of its constants and variables, in the order in which they were added.
  const std::vector<std::string>& names() const { return names_; }
  void AddConstant(const std::string& name, double value);
  /// Its value is where the result points; 0 at first.
  double& AddVariable(const std::string& name);

  tl::expected<Formula, FormulaError> Read(const std::string& text) const;

 private:
  std::shared_ptr<const mu::Parser> parser_;  ///< with the names, without a formula
  std::vector<std::shared_ptr<double>> variables_;
  std::vector<std::string> names_;
};

}  // namespace prehend::witnesses

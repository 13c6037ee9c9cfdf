// SPDX-License-Identifier: Apache-2.0
// Tested by tests/witnesses/closed_form/formula_test.cc
#include "tests/witnesses/closed_form/formula.h"

#include <muParser.h>

#include <algorithm>
#include <cmath>

namespace prehend::witnesses {
namespace {

double Ramp(double t, double from, double to) {
  return t <= from ? 0 : t >= to ? 1 : (t - from) / (to - from);
}

double Mod(double a, double b) { return a - b * std::floor(a / b); }

/// The offset of a '=' that stands alone, or npos: muParser would assign to a variable.
std::size_t Assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
    } else if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) {
      return i;
    }
  }
  return std::string::npos;
}

/// muParser's tokens may end with blanks.
std::string TokenOf(const mu::ParserError& error) {
  const std::string& token = error.GetToken();
  return token.substr(0, token.find_last_not_of(' ') + 1);
}

FormulaError ErrorOf(const mu::ParserError& error, const std::string& text) {
  const std::string token = TokenOf(error);
  const int offset = std::clamp(error.GetPos(), 0, static_cast<int>(text.size()));
  switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
    case mu::ecINVALID_NAME:
      return {"unknown name '" + token + "'", offset, token};
    case mu::ecUNEXPECTED_EOF:
    case mu::ecEMPTY_EXPRESSION:
      return {"the formula ends too early", static_cast<int>(text.size()), {}};
    case mu::ecMISSING_PARENS:
      return {"a ')' is missing", static_cast<int>(text.size()), {}};
    case mu::ecTOO_MANY_PARAMS:
      return {"too many arguments of '" + token + "'", offset, {}};
    case mu::ecTOO_FEW_PARAMS:
      return {"too few arguments of '" + token + "'", offset, {}};
    default:
      if (token.empty()) return {"not a formula", offset, {}};
      return {"unexpected '" + token + "'", offset, {}};
  }
}

}  // namespace

double Formula::Value() const { return parser_->Eval(); }

FormulaScope::FormulaScope() {
  auto parser = std::make_shared<mu::Parser>();
  parser->DefineFun("ramp", Ramp);
  parser->DefineFun("mod", Mod);
  parser_ = std::move(parser);
}

bool FormulaScope::Knows(const std::string& name) const {
  return std::ranges::find(names_, name) != names_.end() || parser_->GetFunDef().contains(name);
}

void FormulaScope::AddConstant(const std::string& name, double value) {
  auto parser = std::make_shared<mu::Parser>(*parser_);
  parser->DefineConst(name, value);
  parser_ = std::move(parser);
  names_.push_back(name);
}

double& FormulaScope::AddVariable(const std::string& name) {
  variables_.push_back(std::make_shared<double>(0));
  auto parser = std::make_shared<mu::Parser>(*parser_);
  parser->DefineVar(name, variables_.back().get());
  parser_ = std::move(parser);
  names_.push_back(name);
  return *variables_.back();
}

tl::expected<Formula, FormulaError> FormulaScope::Read(const std::string& text) const {
  if (const std::size_t at = Assignment(text); at != std::string::npos)
    return tl::unexpected(
        FormulaError{"unexpected '='; to compare, write '=='", static_cast<int>(at), {}});
  auto parser = std::make_shared<mu::Parser>(*parser_);
  try {
    parser->SetExpr(text);
    parser->Eval();
  } catch (const mu::ParserError& error) {
    return tl::unexpected(ErrorOf(error, text));
  }
  if (parser->GetNumResults() != 1)
    return tl::unexpected(
        FormulaError{"expected one formula, found several with ',' between them", 0, {}});
  return Formula(std::move(parser));
}

}  // namespace prehend::witnesses

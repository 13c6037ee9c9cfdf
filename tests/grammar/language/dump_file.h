// SPDX-License-Identifier: Apache-2.0
// A whole syntax tree as text again, so that tests can compare what was read.
#pragma once

#include <string>

#include "grammar/language/ast.h"

namespace prehend::grammar::ast {

/// The whole file as fully bracketed text in SI units, one definition per line.
std::string Dump(const File& file);

}  // namespace prehend::grammar::ast

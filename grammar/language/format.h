// SPDX-License-Identifier: Apache-2.0
// A grammar's text, laid out as the library's: one blank between tokens, clauses indented, comments
// and line breaks kept. Tested by tests/grammar/language/format_test.cc
#pragma once

#include <string>

#include "grammar/base/source.h"

namespace prehend::grammar {

/// Another text of the same meaning; of text that cannot be read as tokens, the text as it is.
std::string FormatText(const GrammarText& grammar);

}  // namespace prehend::grammar

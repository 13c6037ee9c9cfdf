// SPDX-License-Identifier: Apache-2.0
// Who is heard instead of a grammar, by check, report and render. Tested by
// tests/program/recogniser_test.cc
#pragma once

#include <string>

#include "harness/cli/command/command.h"
#include "harness/suite/judge/other_view.h"

namespace prehend::cli {

/// A command, or files:FOLDER; hears nobody if it is "".
suite::Listen ListenTo(const std::string& typed);

Option RecogniserOption();

/// Of --grammar, or a grammar that is named as the recogniser.
std::string GrammarOf(const ParsedOptions& options, const CommandContext& context);
/// Of --recogniser what is no grammar, or "".
std::string RecogniserOf(const ParsedOptions& options, const CommandContext& context);

}  // namespace prehend::cli

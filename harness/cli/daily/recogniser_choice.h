// SPDX-License-Identifier: Apache-2.0
// Who is heard instead of a grammar, by check, report and render. Tested by
// tests/program/recogniser_test.cc
#pragma once

#include <string>

#include "harness/cli/command/command.h"
#include "harness/suite/check/run_suite.h"

namespace prehend::cli {

/// A command, or files:FOLDER.
suite::Listen ListenTo(const std::string& typed);

Option RecogniserOption();
/// Who is named there, who may also be a grammar.
void HearWho(const ParsedOptions& options, suite::SuiteRequest& request);

}  // namespace prehend::cli

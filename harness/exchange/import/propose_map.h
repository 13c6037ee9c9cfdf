// SPDX-License-Identifier: Apache-2.0
// A first map for a file of poses, of what the file itself tells; what it does not tell is to be
// filled in. Tested by tests/program/import_propose_test.cc
#pragma once

#include <string>

#include "harness/base/base/result.h"

namespace prehend::exchange {

/// The text of a map that `import` accepts. Bodies, units, axes and times as they are known or
/// guessed; sizes are `unknown`; what is doubtful is said in comments.
Result<std::string> ProposedMap(const std::string& poses_path);

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
// What an import found, for people. Tested by tests/program/import_test.cc
#pragma once

#include <string>

#include "harness/exchange/import/import_poses.h"

namespace prehend::exchange {

/// Extents, rates and gaps of each entity; and how it is turned in its markers' axes, where a time
/// says that.
std::string ImportTable(const Imported& imported);

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
// The keys of the map of an import. Tested by tests/program/import_test.cc
#pragma once

#include "harness/exchange/poses/import_map.h"

namespace prehend::exchange {

ValueFormat<ImportMap> MapFormat();

}  // namespace prehend::exchange

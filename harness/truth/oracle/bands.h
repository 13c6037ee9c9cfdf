// SPDX-License-Identifier: Apache-2.0
// The bands of the definitions' numbers. A definition such as "short gaps are bridged" has no sharp
// number: any within the band is a fair reading of it. The bands are those of the table in
// docs/events.md. Tested by tests/harness/truth/oracle/bands_test.cc
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "harness/truth/oracle/settings.h"

namespace prehend::truth {

struct Band {
  std::string_view number;  ///< its name in the table of docs/events.md
  double OracleSettings::*setting = nullptr;
  double low = 0, high = 0;  ///< SI units, both allowed
};

/// One per number, in the order of the table.
std::span<const Band> DefinitionBands();

/// The numbers of the table first; then each number at the low and at the high end of its band, the
/// others as in the table.
std::vector<OracleSettings> DefinitionChoices();

}  // namespace prehend::truth

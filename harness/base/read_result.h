// SPDX-License-Identifier: Apache-2.0
// What every reader returns: a value, or the complaints that explain why there is none.
#pragma once

#include <optional>

#include "grammar/base/diagnostic.h"

namespace prehend::harness {

/// `value` is set exactly when `diagnostics` is empty.
template <class T>
struct ReadResult {
  std::optional<T> value;
  grammar::Diagnostics diagnostics;
};

}  // namespace prehend::harness

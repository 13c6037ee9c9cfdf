// SPDX-License-Identifier: Apache-2.0
// What a function returns that can fail on input: a value, or the diagnostics that explain why
// there is none, each with its place. Warnings are part of the value. Tested by
// tests/harness/base/base/text_file_test.cc
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "grammar/base/diagnostic.h"

namespace prehend {

/// `if (!result) return tl::unexpected(result.error());` passes the diagnostics on.
template <class T>
using Result = tl::expected<T, grammar::Diagnostics>;

/// The diagnostics of a result, none if it is a value.
template <class T>
grammar::Diagnostics ErrorsOf(const Result<T>& result) {
  return result ? grammar::Diagnostics{} : result.error();
}

}  // namespace prehend

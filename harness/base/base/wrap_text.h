// SPDX-License-Identifier: Apache-2.0
// Texts in lines of a width. Tested by tests/harness/base/base/wrap_text_test.cc
#pragma once

#include <string>
#include <string_view>

namespace prehend {

/// No line is longer than `width`, unless a word is. Lines of the text stay lines; those that are
/// begun here begin with `indent` blanks.
std::string Wrapped(std::string_view text, std::size_t width, std::size_t indent = 0);

}  // namespace prehend

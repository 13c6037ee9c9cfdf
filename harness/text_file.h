// SPDX-License-Identifier: Apache-2.0
// Reads a small text file that a person wrote, and refuses everything that is not one.
// Tested by tests/harness/text_file_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "harness/read_result.h"

namespace prehend::harness {

/// Enough for 10,000 entities on a line each; a larger file is a mistake and would only cost time.
inline constexpr std::uintmax_t kMaxTextFileBytes = 4u << 20;

/// The text, with a byte order mark dropped and CR LF turned into LF. Complains about a missing,
/// unreadable or oversized file (by its size, without reading it), a directory or device, and about
/// what CheckText() refuses.
ReadResult<std::string> ReadTextFile(const std::string& path);

/// Complains when the text is empty, is not UTF-8, or holds control characters (a binary file).
grammar::Diagnostics CheckText(const std::string& file, std::string_view text);

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// Reads a small text file that a person wrote, and refuses anything else.
// Tested by tests/harness/base/base/text_file_test.cc
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include "harness/base/base/result.h"

namespace prehend {

/// Enough for 10,000 entities on a line each; a larger file is a mistake and would only cost time.
inline constexpr std::uintmax_t kMaxTextFileBytes = 4u << 20;

/// The text, without a byte order mark and with CR LF turned into LF; at most `most_bytes` are
/// read. Reports a file whose name is
/// not a ReadableName() (and names it so), that is missing, unreadable or too large (by its size,
/// without reading it), a directory or device, and what CheckText() reports.
Result<std::string> ReadTextFile(const std::string& path,
                                 std::uintmax_t most_bytes = kMaxTextFileBytes);

/// Of a file that may be larger than memory: whole lines, about a megabyte of them.
using TakeBlock = std::function<void(std::string block, bool is_last)>;

/// The same, block by block: what is wrong with the text is known where it comes.
grammar::Diagnostics ReadTextBlocks(const std::string& path, std::uintmax_t most_bytes,
                                    const TakeBlock& take);

/// To look into a file, which is not remembered as an input. What is no regular file has failed: a
/// pipe would be waited for, a device may never end.
std::ifstream OpenRegular(const std::string& path);

/// Reports a text that is empty, is not UTF-8, or holds control characters (a binary file): those
/// of ASCII and U+0080 to U+009F, which terminals obey; what turns the direction of writing (U+202A
/// to U+202E, U+2066 to U+2069); line ends of Unicode's own (U+2028, U+2029); and code points that
/// are no characters, which XML cannot carry (U+FFFE, U+FFFF and their like).
grammar::Diagnostics CheckText(const std::string& file, std::string_view text);

/// Bytes from elsewhere (the output of a process) as text: each byte that CheckText() would report
/// becomes U+FFFD. XML 1.0 and JSON can carry the result.
std::string ReadableText(std::string_view bytes);
/// Likewise of a name of a file or folder, which stands in one line and one cell: tabs and line
/// ends become U+FFFD, too.
std::string ReadableName(std::string_view bytes);
/// Bytes as a terminal may show them: what CheckText() would report is written
/// as JSON writes it, "\u001b"; a byte that is not UTF-8 becomes U+FFFD.
std::string VisibleText(std::string_view bytes);
/// How many bytes at the end begin a sequence of UTF-8 that is not complete.
std::size_t BegunUtf8(std::string_view bytes);

/// The first thing in a value of one file that CheckText() would report, or a tab: "control
/// character U+009B"; "" if there is none.
std::string StrangeIn(std::string_view value);

}  // namespace prehend

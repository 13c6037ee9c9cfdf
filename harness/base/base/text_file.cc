// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "grammar/base/utf8.h"
#include "harness/base/base/input_files.h"

namespace prehend {
namespace {

using grammar::Diagnostic;
using grammar::Diagnostics;
using grammar::Utf8Length;

char32_t CodePoint(std::string_view sequence) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(sequence[i]); };
  if (sequence.size() == 1) return byte(0);
  char32_t code = byte(0) & (0xFFu >> (sequence.size() + 1));
  for (std::size_t i = 1; i < sequence.size(); ++i) code = code << 6 | (byte(i) & 0x3Fu);
  return code;
}

bool IsBetween(char32_t code, char32_t first, char32_t last) {
  return code >= first && code <= last;
}

bool IsControl(char32_t code) {
  return (code < 0x20 && code != '\n' && code != '\t') || IsBetween(code, 0x7F, 0x9F);
}

/// What a text file that a person wrote does not hold: "" or its name.
std::string_view NameOfStrange(char32_t code) {
  if (IsControl(code)) return "control character";
  if (IsBetween(code, 0x202A, 0x202E) || IsBetween(code, 0x2066, 0x2069))
    return "character that turns the direction of writing";
  if (IsBetween(code, 0x2028, 0x2029)) return "line end that only Unicode knows";
  if ((code & 0xFFFE) == 0xFFFE || IsBetween(code, 0xFDD0, 0xFDEF))
    return "code point that is no character";
  return {};
}

/// The sequence that starts `text` is fit for a text file.
bool IsFit(std::string_view text, std::size_t length) {
  return length > 0 && NameOfStrange(CodePoint(text.substr(0, length))).empty();
}

/// Each sequence that is not fit, or that is one of `others`, becomes what `instead` makes of it;
/// it is given "" for a byte that begins no sequence.
template <typename Instead>
std::string Readable(std::string_view bytes, std::string_view others, const Instead& instead) {
  std::string text;
  text.reserve(bytes.size());
  while (!bytes.empty()) {
    const std::size_t length = Utf8Length(bytes);
    const bool fits = IsFit(bytes, length) && others.find(bytes.front()) == std::string_view::npos;
    if (fits)
      text += bytes.substr(0, length);
    else
      text += instead(bytes.substr(0, length));
    bytes.remove_prefix(std::max<std::size_t>(1, length));
  }
  return text;
}

constexpr const char* kNoCharacter = "\uFFFD";

/// Without the line itself: printing it could garble a terminal.
Diagnostic NotText(const std::string& file, std::string_view text, std::size_t offset,
                   std::string message, int first_line = 1) {
  const auto before = text.substr(0, offset);
  const auto line_start = before.rfind('\n') + 1;  // npos + 1 == 0: the first line
  const int line = first_line + static_cast<int>(std::count(before.begin(), before.end(), '\n'));
  return {.file = file,
          .place = {line, 1 + static_cast<int>(offset - line_start)},
          .message = std::move(message),
          .hint = "is this a text file, saved as UTF-8?"};
}

/// With a byte order mark, or as two letters of English look in it.
bool IsUtf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  if (text.size() < 4) return false;
  const auto is_zero = [&](std::size_t i) { return text[i] == '\0'; };
  return is_zero(0) != is_zero(1) && is_zero(0) == is_zero(2) && is_zero(1) == is_zero(3);
}

std::string WithUnixLineEnds(std::string text) {
  if (text.find('\r') == std::string::npos) return text;
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
    out += text[i];
  }
  return out;
}

Diagnostics CheckLines(const std::string& file, std::string_view text, int first_line) {
  const auto not_text = [&](std::size_t offset, std::string message) {
    return NotText(file, text, offset, std::move(message), first_line);
  };
  for (std::size_t i = 0; i < text.size();) {
    if ((text[i] >= ' ' && text[i] <= '~') || text[i] == '\n') {
      ++i;
      continue;
    }
    if (text[i] == '\r') {
      Diagnostic alone = not_text(i, "a carriage return without a line feed");
      alone.hint = "lines end with a line feed, or with both";
      return {std::move(alone)};
    }
    const std::size_t length = Utf8Length(text.substr(i));
    if (length == 0) {
      return {not_text(
          i, fmt::format("byte 0x{:02x} is not UTF-8", static_cast<unsigned char>(text[i])))};
    }
    const char32_t code = CodePoint(text.substr(i, length));
    if (const auto name = NameOfStrange(code); !name.empty()) {
      const auto number = static_cast<unsigned>(code);
      return {not_text(
          i, length == 1 ? fmt::format("{} 0x{:02x}; this looks like a binary file", name, number)
                         : fmt::format("{} U+{:04X}", name, number))};
    }
    i += length;
  }
  return {};
}

/// Why the file at `path` cannot be read as text, found without opening it; empty when it can.
std::string WhyNotReadable(const std::string& path, std::uintmax_t most_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    return error && error != std::errc::no_such_file_or_directory
               ? "cannot be read: " + error.message()
               : "no such file";
  if (std::filesystem::is_directory(status)) return "is a directory, not a file";
  if (!std::filesystem::is_regular_file(status)) return "is not a regular file";
  const auto size = std::filesystem::file_size(path, error);
  if (error) return "cannot be read: " + error.message();
  if (size > most_bytes) {
    return fmt::format("is too large: {:.1f} MiB, at most {} MiB are read",
                       static_cast<double>(size) / (1 << 20), most_bytes >> 20);
  }
  return {};
}

}  // namespace

std::string ReadableText(std::string_view bytes) {
  return Readable(bytes, "", [](std::string_view) { return kNoCharacter; });
}

std::string ReadableName(std::string_view bytes) {
  return Readable(bytes, "\t\n", [](std::string_view) { return kNoCharacter; });
}

std::string VisibleText(std::string_view bytes) {
  return Readable(bytes, "", [](std::string_view sequence) {
    const char32_t code = sequence.empty() ? 0 : CodePoint(sequence);
    return sequence.empty() || code > 0xFFFF
               ? std::string(kNoCharacter)
               : fmt::format("\\u{:04x}", static_cast<unsigned>(code));
  });
}

std::size_t BegunUtf8(std::string_view bytes) {
  for (std::size_t count = 1; count <= std::min<std::size_t>(3, bytes.size()); ++count) {
    const auto lead = static_cast<unsigned char>(bytes[bytes.size() - count]);
    if ((lead & 0xC0) == 0x80) continue;
    const std::size_t wanted = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
    return wanted > count ? count : 0;
  }
  return 0;
}

std::string StrangeIn(std::string_view value) {
  for (std::size_t i = 0; i < value.size();) {
    const std::size_t length = Utf8Length(value.substr(i));
    if (length == 0)
      return fmt::format("byte 0x{:02x} that is not UTF-8", static_cast<unsigned char>(value[i]));
    const char32_t code = CodePoint(value.substr(i, length));
    const std::string_view name = code == '\t' ? "control character" : NameOfStrange(code);
    if (!name.empty()) return fmt::format("{} U+{:04X}", name, static_cast<unsigned>(code));
    i += length;
  }
  return "";
}

Diagnostics CheckText(const std::string& file, std::string_view text) {
  if (text.empty()) return {{.file = file, .message = "the file is empty"}};
  if (IsUtf16(text)) {
    Diagnostic wide = NotText(file, text, 0, "expected UTF-8, found UTF-16");
    wide.hint = "save it as UTF-8";
    return {std::move(wide)};
  }
  return CheckLines(file, text, 1);
}

std::ifstream OpenRegular(const std::string& path) {
  std::error_code error;
  return std::ifstream(std::filesystem::is_regular_file(path, error) ? path : "", std::ios::binary);
}

Diagnostics ReadTextBlocks(const std::string& path, std::uintmax_t most_bytes,
                           const TakeBlock& take) {
  constexpr std::size_t kBlockBytes = 1 << 20;
  const auto refuse = [&](std::string why) {
    return Diagnostics{{.file = ReadableName(path), .message = std::move(why)}};
  };
  if (ReadableName(path) != path)
    return refuse("the name of this file holds what is no printable text; rename it");
  if (auto why = WhyNotReadable(path, most_bytes); !why.empty()) return refuse(std::move(why));
  std::ifstream stream = OpenInput(path);
  if (!stream) return refuse(std::string("cannot be read: ") + std::strerror(errno));
  Diagnostics problems;
  std::string bytes;
  int lines = 0;
  for (bool is_last = false; !is_last && problems.empty();) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kBlockBytes);
    stream.read(bytes.data() + before, kBlockBytes);
    bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
    is_last = stream.peek() == std::ifstream::traits_type::eof();
    const std::size_t cut = std::string_view(bytes).substr(before).rfind('\n');
    if (cut == std::string_view::npos && !is_last) continue;
    const std::size_t end = is_last ? bytes.size() : before + cut + 1;
    const std::size_t begin = lines == 0 && bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    std::string block = WithUnixLineEnds(bytes.substr(begin, end - begin));
    bytes.erase(0, end);
    problems = lines == 0 ? CheckText(path, block) : CheckLines(path, block, lines + 1);
    lines += static_cast<int>(std::ranges::count(block, '\n'));
    if (problems.empty()) take(std::move(block), is_last);
  }
  return stream.bad() ? refuse("cannot be read to its end") : problems;
}

Result<std::string> ReadTextFile(const std::string& path, std::uintmax_t most_bytes) {
  std::string text;
  const auto add = [&](const std::string& block, bool) { text += block; };
  if (Diagnostics problems = ReadTextBlocks(path, most_bytes, add); !problems.empty())
    return tl::unexpected(std::move(problems));
  return text;
}

}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// The one door out: what the program prints passes here, wherever it came from (rows of an episode
// file, names in an MCAP file, words of Prolog). No terminal obeys it.
// Tested by tests/harness/base/base/visible_stream_test.cc
#pragma once

#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

namespace prehend {

/// Stands before a stream's buffer for as long as it lives. What CheckText() would report is
/// written as JSON writes it ("\u001b", "\u202e"), so that JSON stays what it is; a byte that is
/// not UTF-8 as U+FFFD.
class VisibleBuffer : public std::streambuf {
 public:
  explicit VisibleBuffer(std::ostream& stream);
  ~VisibleBuffer() override;
  VisibleBuffer(const VisibleBuffer&) = delete;
  VisibleBuffer& operator=(const VisibleBuffer&) = delete;

  /// As it is.
  void PassOn(std::string_view code);

 protected:
  int_type overflow(int_type byte) override;
  std::streamsize xsputn(const char* bytes, std::streamsize count) override;
  int sync() override;

 private:
  bool Write(std::string_view bytes);

  std::ostream& stream_;
  std::streambuf* const below_;
  std::string begun_;  ///< of a UTF-8 sequence whose other bytes are still to come
};

/// What the program itself tells a terminal: a colour, a line that is written anew.
struct TerminalCode {
  const char* code;
};
inline constexpr TerminalCode kEraseLine{"\r\033[K"};

std::ostream& operator<<(std::ostream& stream, const TerminalCode& code);

}  // namespace prehend

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

/// As much of a line of messages as a person reads: of a diagnostic 2,000 bytes and its place.
inline constexpr std::size_t kMostLine_bytes = 2200;

/// Stands before a stream's buffer for as long as it lives. What CheckText() would report is
/// written as JSON writes it ("\u001b", "\u202e"), so that JSON stays what it is; a byte that is
/// not UTF-8 as U+FFFD.
class VisibleBuffer : public std::streambuf {
 public:
  /// The rest of a line that is longer than `most_bytes` is not written, but counted; 0: it is.
  explicit VisibleBuffer(std::ostream& stream, std::size_t most_bytes = 0);
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
  std::string Cut(std::string_view text);
  std::string BeyondText() const;

  std::ostream& stream_;
  std::streambuf* const below_;
  const std::size_t most_bytes_;
  std::size_t column_ = 0, beyond_ = 0;  ///< bytes of this line that were written, and were not
  std::string begun_;  ///< of a UTF-8 sequence whose other bytes are still to come
};

/// What the program itself tells a terminal: a colour, a line that is written anew.
struct TerminalCode {
  const char* code;
};
inline constexpr TerminalCode kEraseLine{"\r\033[K"};

std::ostream& operator<<(std::ostream& stream, const TerminalCode& code);

}  // namespace prehend

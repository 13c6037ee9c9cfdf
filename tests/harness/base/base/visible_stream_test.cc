// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/visible_stream.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace prehend {
namespace {

/// What comes out if these pieces are printed one after the other.
template <typename... Pieces>
std::string Printed(const Pieces&... pieces) {
  std::ostringstream stream;
  {
    const VisibleBuffer visible(stream);
    (stream << ... << pieces);
  }
  return std::move(stream).str();
}

TEST(VisibleStream, PassesTextOn) {
  const std::string text = "a\tb\n\u00e4\u20ac\U0001f600 \u2192";
  EXPECT_EQ(Printed(text), text);
}

TEST(VisibleStream, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(Printed("a\x1b[31mb\x07"), "a\\u001b[31mb\\u0007");
  EXPECT_EQ(Printed("\r\x7f\u009b"), "\\u000d\\u007f\\u009b");
  EXPECT_EQ(Printed("\u202eabc\u2066\u2028"), "\\u202eabc\\u2066\\u2028");
  EXPECT_EQ(Printed(std::string("\0", 1)), "\\u0000");
}

TEST(VisibleStream, KeepsJsonWellFormed) {
  EXPECT_EQ(Printed("{\"name\": \"a\u202eb\"}"), "{\"name\": \"a\\u202eb\"}");
  EXPECT_EQ(Printed("\U0001fffe"), "\uFFFD") << "\\u1fffe would be two characters of JSON";
}

TEST(VisibleStream, BytesThatAreNoTextBecomeOneSign) {
  EXPECT_EQ(Printed("a\xff\xc0z"), "a\uFFFD\uFFFDz");
  EXPECT_EQ(Printed("\xe2\x82"), "\uFFFD") << "cut off at the end";
}

TEST(VisibleStream, ACharacterMayComeInPieces) {
  EXPECT_EQ(Printed('\xe2', '\x82', '\xac', "\xf0\x9f", "\x98\x80"), "\u20ac\U0001f600");
  EXPECT_EQ(Printed('\xe2', '\x80', '\xae'), "\\u202e") << "nor can it hide so";
}

TEST(VisibleStream, TheProgramsOwnCodesPass) {
  EXPECT_EQ(Printed(kEraseLine, "[1/2] a\x1b[K"), "\r\x1b[K[1/2] a\\u001b[K");
  std::ostringstream plain;
  plain << kEraseLine;
  EXPECT_EQ(plain.str(), "\r\x1b[K");
}

TEST(VisibleStream, ALineOfMessagesIsAsLongAsAPersonReads) {
  std::ostringstream stream;
  {
    const VisibleBuffer visible(stream, 10);
    stream << "0123456789\n"
           << "01234"
           << "56789abc"
           << "d\n12345678é9é0\n";
    stream << "in progress" << kEraseLine << "done\n";
    stream << "0123456789" << 123;
  }
  EXPECT_EQ(stream.str(),
            "0123456789\n0123456789... (4 bytes more)\n12345678é... (4 bytes more)\n"
            "in progres\r\033[Kdone\n0123456789... (3 bytes more)");
}

}  // namespace
}  // namespace prehend

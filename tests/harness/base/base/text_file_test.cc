// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/text_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>

namespace prehend {
namespace {

class TextFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / ("text_file_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& text) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  /// The only complaint about a file.
  static std::string Complaint(const std::string& path) {
    const auto read = ReadTextFile(path);
    EXPECT_FALSE(read.has_value());
    return ErrorsOf(read).size() == 1 ? ErrorsOf(read)[0].message : "not one complaint";
  }

  std::filesystem::path folder_;
};

TEST_F(TextFile, DropsByteOrderMarkAndCarriageReturns) {
  EXPECT_EQ(ReadTextFile(Write("dos",
                               "\xEF\xBB\xBF"
                               "a: 1\r\nb: 2\r\n")),
            "a: 1\nb: 2\n");
}

TEST_F(TextFile, KeepsUnicode) {
  const std::string text = "shows: Milchtüte \xF0\x9F\xA5\x9B\n";
  EXPECT_EQ(ReadTextFile(Write("unicode", text)), text);
}

TEST_F(TextFile, RefusesWhatIsNoTextFile) {
  EXPECT_EQ(Complaint(folder_ / "missing"), "no such file");
  EXPECT_EQ(Complaint(folder_), "is a directory, not a file");
  EXPECT_EQ(Complaint("/dev/zero"), "is not a regular file");
  EXPECT_EQ(Complaint(Write("empty", "")), "the file is empty");
  EXPECT_EQ(Complaint(Write("nul", std::string("a\0b", 3))),
            "control character 0x00; this looks like a binary file");
  EXPECT_EQ(Complaint(Write("elf",
                            "\x7f"
                            "ELF")),
            "control character 0x7f; this looks like a binary file");
}

TEST_F(TextFile, NamesUtf16) {
  for (const std::string& text :
       {std::string("\xFF\xFE"
                    "a\0:\0",
                    6),
        std::string("\xFE\xFF\0a\0:", 6), std::string("a\0:\0", 4), std::string("\0a\0:", 4)})
    EXPECT_EQ(Complaint(Write("wide", text)), "expected UTF-8, found UTF-16");
}

TEST_F(TextFile, RefusesWhatTerminalsObeyAndXmlCannotCarry) {
  EXPECT_EQ(Complaint(Write("c1", "a\u009b31m")), "control character U+009B");
  EXPECT_EQ(Complaint(Write("turned", "a\u202eb")),
            "character that turns the direction of writing U+202E");
  EXPECT_EQ(Complaint(Write("line", "a\u2028b")), "line end that only Unicode knows U+2028");
  EXPECT_EQ(Complaint(Write("none", "a\uFFFEb")), "code point that is no character U+FFFE");
  EXPECT_EQ(Complaint(Write("far", "a\U0010FFFFb")), "code point that is no character U+10FFFF");
}

TEST_F(TextFile, RefusesBrokenUtf8) {
  for (const char* bytes : {"\x80", "\xC0\x80", "\xC3", "\xE0\x80\x80", "\xED\xA0\x80",
                            "\xF0\x80\x80\x80", "\xF4\x90\x80\x80", "\xFF"}) {
    const auto diagnostics = CheckText("f", std::string("ab\ncd") + bytes);
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_NE(diagnostics[0].message.find("is not UTF-8"), std::string::npos);
    EXPECT_EQ(diagnostics[0].place.line, 2);
    EXPECT_EQ(diagnostics[0].place.column, 3);
  }
}

TEST_F(TextFile, RefusesALargeFileByItsSize) {
  const std::string path = Write("large", "x");
  std::filesystem::resize_file(path, 50u << 20);  // sparse: nothing to read
  EXPECT_EQ(Complaint(path), "is too large: 50.0 MiB, at most 4 MiB are read");
}

TEST_F(TextFile, RefusesAnUnreadableFile) {
  const std::string path = Write("secret", "a: 1\n");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  // Root reads everything, so for a moment it is nobody.
  constexpr uid_t kNoEntity = 65534;
  const uid_t me = geteuid();
  if (me == 0 && seteuid(kNoEntity) != 0)
    GTEST_SKIP() << "root reads everything, and nobody is not known in this user namespace";
  const std::string complaint = Complaint(path);
  ASSERT_EQ(seteuid(me), 0);
  EXPECT_EQ(complaint, "cannot be read: Permission denied");
}

TEST(ReadableText, KeepsTextAndReplacesWhatIsNone) {
  EXPECT_EQ(ReadableText("tab\tand\nline, \u00e9 \U0001F590"), "tab\tand\nline, \u00e9 \U0001F590");
  EXPECT_EQ(ReadableText(""), "");
  EXPECT_EQ(ReadableText("\u009b1m \u2028 \uFFFE"), "\uFFFD1m \uFFFD \uFFFD");
  EXPECT_EQ(ReadableText("\x1b[31m\r\n"), "\uFFFD[31m\uFFFD\n");
  EXPECT_EQ(ReadableText(std::string_view("a\0b", 3)), "a\uFFFDb");
  EXPECT_EQ(ReadableText("\xa9 tail of a cut \u00e9, head of one: \xc3"),
            "\uFFFD tail of a cut \u00e9, head of one: \uFFFD");
}

TEST_F(TextFile, NamesStandInOneLine) {
  EXPECT_EQ(ReadableName("Milch tüte"), "Milch tüte");
  EXPECT_EQ(ReadableName("a\nb\tc\x1b[1m\xff"), "a\uFFFDb\uFFFDc\uFFFD[1m\uFFFD");
  const auto read = ReadTextFile(Write("a\xff", "a: 1\n"));
  ASSERT_FALSE(read.has_value());
  EXPECT_TRUE(ErrorsOf(read)[0].file.ends_with("a\uFFFD"));
  EXPECT_EQ(ErrorsOf(read)[0].message,
            "the name of this file holds what is no printable text; rename it");
}

TEST_F(TextFile, SaysWhatIsStrangeInAValue) {
  EXPECT_EQ(StrangeIn("two\nlines, Milchtüte"), "");
  EXPECT_EQ(StrangeIn("a\tb"), "control character U+0009");
  EXPECT_EQ(StrangeIn("\u009b31m"), "control character U+009B");
  EXPECT_EQ(StrangeIn("a\u202eb"), "character that turns the direction of writing U+202E");
  EXPECT_EQ(StrangeIn("\ufffe"), "code point that is no character U+FFFE");
  EXPECT_EQ(StrangeIn("\xff"), "byte 0xff that is not UTF-8");
}

TEST_F(TextFile, IsReadInBlocksOfWholeLines) {
  std::string text;
  for (int i = 0; text.size() < 3'500'000; ++i) text += "line " + std::to_string(i) + "\r\n";
  const std::string path = Write("long", "\xEF\xBB\xBF" + text + "cut off");
  std::string together;
  std::vector<bool> last;
  const auto take = [&](const std::string& block, bool is_last) {
    EXPECT_TRUE(block.ends_with('\n') || block.ends_with("\ncut off"));
    EXPECT_LT(block.size(), 1'200'000);
    together += block;
    last.push_back(is_last);
  };
  EXPECT_EQ(ReadTextBlocks(path, 1 << 30, take).size(), 0);
  EXPECT_EQ(last, (std::vector<bool>{false, false, false, true}));
  EXPECT_EQ(together, ReadTextFile(path, 1 << 30));
  EXPECT_EQ(together.find('\r'), std::string::npos);
  EXPECT_TRUE(together.starts_with("line 0\nline 1\n"));
}

TEST_F(TextFile, FaultsOfLaterBlocksAreWhereTheyAre) {
  std::string text;
  for (int i = 0; i < 400'000; ++i) text += "line\n";
  const std::string path = Write("fault", text + "ab\xff\n");
  std::size_t bytes = 0;
  const auto problems =
      ReadTextBlocks(path, 1 << 30, [&](const std::string& block, bool) { bytes += block.size(); });
  EXPECT_EQ(bytes, 1'048'575) << "those before it were taken";
  ASSERT_EQ(problems.size(), 1);
  EXPECT_EQ(problems[0].message, "byte 0xff is not UTF-8");
  EXPECT_EQ(problems[0].place.line, 400'001);
  EXPECT_EQ(problems[0].place.column, 3);
}

Result<std::unique_ptr<int>> Half(int number) {
  if (number % 2 != 0) return tl::unexpected(grammar::Diagnostics{{.message = "odd"}});
  return std::make_unique<int>(number / 2);
}

Result<int> Quarter(int number) {
  PREHEND_TRY(const std::unique_ptr<int> half, Half(number));
  int quarter = 0;
  PREHEND_TRY(const auto again, Half(*half));
  quarter = *again;
  return quarter;
}

grammar::Diagnostics WrongWith(int number) {
  std::unique_ptr<int> half;
  PREHEND_TRY(half, Half(number));
  return *half == 0 ? grammar::Diagnostics{{.message = "nothing"}} : grammar::Diagnostics{};
}

TEST(Try, TakesTheValueOrReturnsTheError) {
  EXPECT_EQ(Quarter(12), 3);
  ASSERT_FALSE(Quarter(3));
  EXPECT_EQ(Quarter(3).error()[0].message, "odd");
  ASSERT_FALSE(Quarter(6)) << "the second one fails";
  EXPECT_EQ(Quarter(6).error().size(), 1u);
  EXPECT_TRUE(WrongWith(4).empty());
  ASSERT_EQ(WrongWith(5).size(), 1u) << "where errors are what is returned";
  EXPECT_EQ(WrongWith(5)[0].message, "odd");
  EXPECT_EQ(WrongWith(0)[0].message, "nothing");
}

}  // namespace
}  // namespace prehend

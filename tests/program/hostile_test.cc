// SPDX-License-Identifier: Apache-2.0
// A project folder in which something strange lies about: names that are no text, links, pipes. It
// costs the verdict of what is strange, never that of the rest.
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

class Hostile : public SmallProject {};

bool IsPlain(const std::string& text) {
  return text.find('\x1b') == std::string::npos && text.find('\xff') == std::string::npos &&
         text.find("\xe2\x80\xa8") == std::string::npos &&
         text.find("\xe2\x80\xae") == std::string::npos;
}

// Not UTF-8, an escape sequence, a line end in the name, U+2028, U+202E.
TEST_F(Hostile, NamesThatAreNoTextCostOneVerdict) {
  Accept();
  for (const char* name : {"a\xff", "b\x1b[31mb", "c\nfailed", "d\xe2\x80\xa8", "e\xe2\x80\xae"}) {
    fs::copy(Scenario(), root_ / "scenarios/rest" / (std::string(name) + ".yaml"));
    fs::create_directories(root_ / "scenarios" / name);
  }
  fs::copy(Scenario(), root_ / "scenarios/a\xff/carton_rests.yaml");
  fs::copy(Golden(), root_ / "golden/rest/orphan\x1b[31m.timeline");
  const fs::path junit = root_ / "junit.xml";
  for (const std::string& command :
       {std::string("list"), std::string("list --json"), std::string("validate"),
        std::string("validate --json"), std::string("check --no-pictures --changed"),
        std::string("check --no-pictures --json"),
        "check --no-pictures --junit " + junit.string()}) {
    const Said said = Do(command);
    EXPECT_EQ(said.exit_code, 2) << command << "\n" << said.err;
    EXPECT_TRUE(IsPlain(said.out) && IsPlain(said.err)) << command;
    EXPECT_NE((said.out + said.err).find("the name of this file holds what is no printable text"),
              std::string::npos)
        << command;
    const bool is_json = command.ends_with("--json");
    EXPECT_TRUE(!is_json || nlohmann::json::accept(said.out)) << command;
    const bool passed = said.out.find("passed") != std::string::npos;
    EXPECT_EQ(passed, command.starts_with("check")) << command;
  }
  EXPECT_TRUE(IsPlain(ReadFile(junit)));
}

// Annexes, stores and sandboxes link each file.
TEST_F(Hostile, ALinkedGoldenIsNoOrphan) {
  Accept();
  fs::create_directories(root_ / "store");
  fs::rename(Golden(), root_ / "store/0123abcd");
  fs::create_symlink("../../store/0123abcd", Golden());
  EXPECT_EQ(Do("check --no-pictures").exit_code, 0) << Do("check --no-pictures").out;
  EXPECT_EQ(Do("validate").exit_code, 0) << Do("validate").err;
}

// A library's grammar of the same name is not what was meant.
TEST_F(Hostile, AnUnreadableGrammarIsNotPassedOver) {
  WriteFile(root_ / "mine.grammar", "grammar mine\nuse contact\n");
  EXPECT_EQ(Do("validate " + (root_ / "mine.grammar").string()).exit_code, 0);
  WriteFile(root_ / "contact.grammar", "grammar contact # \xff\n");
  const Said said = Do("validate " + (root_ / "mine.grammar").string());
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("contact.grammar:1:19: error: byte 0xff is not UTF-8"), std::string::npos)
      << said.err;
}

// Both are asked for by a person; neither reason is lost.
TEST_F(Hostile, TwoAcceptsAtOnceKeepBothReasons) {
  const std::string accept = "PREHEND_HOME='" + root_.string() +
                             "' CI= '" PREHEND_BINARY_DIR
                             "/prehend' accept carton_rests >/dev/null 2>&1 --reason ";
  Accept();
  const std::string both =
      "( " + accept + "first --derived one & " + accept + "second --derived two & wait )";
  ASSERT_EQ(std::system(both.c_str()), 0);
  const std::string golden = ReadFile(Golden());
  EXPECT_NE(golden.find("first"), std::string::npos) << golden;
  EXPECT_NE(golden.find("second"), std::string::npos) << golden;
}

/// Words that hurt: no UTF-8, controls of all kinds, what is syntax in goldens, shells and formats.
std::string HostileWords(std::mt19937& random) {
  const std::vector<std::string> parts = {"\xe9t\xe9",
                                          "\xff\xfe",
                                          "\xc0\xaf",
                                          "\xed\xa0\x80",
                                          "\x1b[31m",
                                          "\xc2\x9b"
                                          "31m",
                                          "\n",
                                          "\r",
                                          "\t",
                                          "\x01",
                                          "\x7f",
                                          "\"",
                                          "\\",
                                          "\\n",
                                          "\\\"",
                                          "#",
                                          "# accepted: ",
                                          "event",
                                          ": ",
                                          "'",
                                          "$(exit 9)",
                                          "`exit 9`",
                                          "\xe2\x80\xae",
                                          "\xe2\x80\xa8",
                                          "\xef\xbf\xbe",
                                          "\xef\xbb\xbf",
                                          "\xf0\x9f\xa5\x9b",
                                          "\xe6\x97\xa5",
                                          "e\xcc\x81",
                                          "%s%n",
                                          "{}",
                                          "--json",
                                          "-",
                                          "",
                                          " ",
                                          "a reason",
                                          "spread=1.0/2.0ms",
                                          std::string(3000, 'x'),
                                          std::string(200, '"')};
  std::string words;
  for (std::size_t n = 1 + random() % 4; n > 0; --n) words += parts[random() % parts.size()];
  return words;
}

TEST_F(Hostile, AReasonLeavesTheGoldenReadableOrUntouched) {
  std::mt19937 random(1);
  const auto accept = [&](const std::string& name, const std::string& reason, const char* option) {
    return Prehend({"accept", name, option, reason, "--reason", "tried"},
                   {"PREHEND_HOME=" + root_.string(), "CI="});
  };
  Accept();
  const std::string first = ReadFile(Golden());
  int accepted = 0;
  for (int i = 0; i < 200; ++i) {
    const std::string words = HostileWords(random);
    const bool as_derivation = i % 2 == 0;
    if (!as_derivation) fs::remove(Golden());
    const Said said = as_derivation ? accept("carton_rests", words, "--derived")
                                    : Prehend({"accept", "carton_rests", "--reason", words},
                                              {"PREHEND_HOME=" + root_.string(), "CI="});
    EXPECT_TRUE(said.exit_code == 0 || said.exit_code == 2) << said.exit_code << words << said.err;
    EXPECT_TRUE(IsPlain(said.out) && IsPlain(said.err)) << words;
    const std::string golden = ReadFile(Golden());
    if (said.exit_code == 0) {
      ++accepted;
      EXPECT_EQ(Do("validate").exit_code, 0) << golden;
    } else {
      EXPECT_EQ(golden, as_derivation ? first : "") << words;
    }
    WriteFile(Golden(), first);
  }
  EXPECT_GT(accepted, 20) << "some are plain text";
  EXPECT_LT(accepted, 180);
  for (int i = 0; i < 40; ++i) {
    const std::string words = HostileWords(random);
    const Said said = accept("../" + words, "no such", "--derived");
    EXPECT_TRUE(said.exit_code == 2 || said.exit_code == 4) << said.exit_code << words;
    EXPECT_TRUE(IsPlain(said.err)) << words;
  }
  EXPECT_EQ(ReadFile(Golden()), first);
}

}  // namespace
}  // namespace prehend::house

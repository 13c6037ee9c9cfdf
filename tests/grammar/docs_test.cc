// SPDX-License-Identifier: Apache-2.0
// Every example of docs/grammar-language.md compiles as it stands.
#include <gtest/gtest.h>

#include "tests/grammar/corpus.h"

namespace prehend::grammar {
namespace {

TEST(Docs, ExamplesCompile) {
  const std::string docs = testing::ReadFile(PREHEND_SOURCE_DIR "/docs/grammar-language.md");
  int examples = 0;
  std::size_t at = 0;
  for (std::size_t open; (open = docs.find("```\n", at)) != std::string::npos;) {
    const std::size_t begin = open + 4;
    const std::size_t end = docs.find("```", begin);
    ASSERT_NE(end, std::string::npos);
    const std::string block = docs.substr(begin, end - begin);
    at = end + 3;
    if (!block.starts_with("grammar ")) continue;
    const CompileResult result = Compile({"docs", block}, testing::LibraryIncluder());
    EXPECT_TRUE(result.program) << Format(result.diagnostics);
    ++examples;
  }
  EXPECT_GE(examples, 8);
}

}  // namespace
}  // namespace prehend::grammar

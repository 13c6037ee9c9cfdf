// SPDX-License-Identifier: Apache-2.0
#include "grammar/base/check.h"

#include <gtest/gtest.h>

namespace prehend::grammar {
namespace {

TEST(Check, PassesWhatIsTrue) { EXPECT_NO_THROW(PREHEND_CHECK(1 + 1 == 2)); }

TEST(Check, SaysWhereAndWhatWasNotTrue) {
  const int answer = 3;
  try {
    PREHEND_CHECK(answer == 4);
    FAIL() << "nothing was thrown";
  } catch (const std::logic_error& error) {
    const std::string text = error.what();
    EXPECT_TRUE(text.starts_with("internal error: ")) << text;
    EXPECT_NE(text.find("check_test.cc:"), std::string::npos) << text;
    EXPECT_TRUE(text.ends_with(": not true: answer == 4")) << text;
  }
}

TEST(Check, DebugChecksCostNothingElsewhere) {
  int asked = 0;
  const auto ask = [&] { return ++asked > 0; };
  PREHEND_DCHECK(ask());
#ifdef PREHEND_DEBUG_CHECKS
  EXPECT_EQ(asked, 1);
  EXPECT_THROW(PREHEND_DCHECK(asked == 2), std::logic_error);
#else
  EXPECT_EQ(asked, 0);
  EXPECT_NO_THROW(PREHEND_DCHECK(asked == 2));
#endif
}

}  // namespace
}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/base/base/quoting.h"

namespace prehend {
namespace {

TEST(WrapText, NoLineIsLongerThanItsWidthUnlessAWordIs) {
  EXPECT_EQ(Wrapped("a cup is lifted", 15), "a cup is lifted");
  EXPECT_EQ(Wrapped("a cup is lifted", 14), "a cup is\nlifted");
  EXPECT_EQ(Wrapped("a cup is lifted", 8, 2), "a cup is\n  lifted");
  EXPECT_EQ(Wrapped("pick_and_place ends", 5), "pick_and_place\nends");
  EXPECT_EQ(Wrapped("  a cup is lifted", 10, 2), "  a cup is\n  lifted");
  EXPECT_EQ(Wrapped("", 5), "");
}

TEST(WrapText, LinesStayLines) {
  EXPECT_EQ(Wrapped("one two\nthree four five", 10, 1), "one two\nthree four\n five");
  EXPECT_EQ(Wrapped("one\ntwo\n", 10), "one\ntwo\n");
}

}  // namespace
}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// A shell reads back what was quoted.
#include <gtest/gtest.h>

#include "harness/base/base/quoting.h"

namespace prehend {
namespace {

TEST(ShellQuoted, QuotesOnlyWhatNeedsIt) {
  EXPECT_EQ(ShellQuoted("slide/carton_slides.yaml"), "slide/carton_slides.yaml");
  EXPECT_EQ(ShellQuoted("lift_rise=3cm"), "lift_rise=3cm");
  EXPECT_EQ(ShellQuoted(""), "''");
  EXPECT_EQ(ShellQuoted("my file"), "'my file'");
  EXPECT_EQ(ShellQuoted("slide/*"), "'slide/*'");
  EXPECT_EQ(ShellQuoted("$(rm x); \"y\""), "'$(rm x); \"y\"'");
  EXPECT_EQ(ShellQuoted("it's"), "'it'\\''s'");
}

}  // namespace
}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/median.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace prehend {
namespace {

TEST(Median, IsTheMiddleOrBetweenTheTwoInTheMiddle) {
  EXPECT_EQ(Median(std::vector<double>{}), 0);
  EXPECT_EQ(Median(std::vector<double>{7}), 7);
  EXPECT_EQ(Median(std::vector<double>{3, -8, 5}), 3);
  EXPECT_EQ(Median(std::vector<double>{-2900, 400}), -1250) << "two errors, in ms";
  EXPECT_EQ(Median(std::vector<double>{9, 1, 4, 2}), 3);
  EXPECT_EQ(Median(std::vector<double>{5, 5, 5, 1}), 5);
  EXPECT_EQ(Median(std::vector<std::int64_t>{166, 168, 166, 168}), 167);
}

}  // namespace
}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
#include "grammar/engine/stable_blocks.h"

#include <gtest/gtest.h>

namespace prehend::grammar {
namespace {

TEST(StableBlocks, ElementsStayWhereTheyAre) {
  StableBlocks<int> numbers;
  EXPECT_EQ(numbers.size(), 0u);
  const int* first = &numbers.PushBack();
  for (int i = 1; i < 1000; ++i) numbers.PushBack() = i;
  EXPECT_EQ(numbers.size(), 1000u);
  EXPECT_EQ(first, &numbers[0]);
  for (std::size_t i = 1; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], static_cast<int>(i));
}

}  // namespace
}  // namespace prehend::grammar

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/state/instance_index.h"

namespace prehend::grammar {
namespace {

using NumberId = Id<struct NumberTag>;

TEST(StableBlocks, ElementsStayWhereTheyAre) {
  StableBlocks<NumberId, int> numbers;
  EXPECT_EQ(numbers.size(), 0u);
  const int* first = &numbers.PushBack();
  for (int i = 1; i < 1000; ++i) numbers.PushBack() = i;
  EXPECT_EQ(numbers.size(), 1000u);
  EXPECT_EQ(first, &numbers[NumberId(0)]);
  for (int i = 1; i < 1000; ++i) EXPECT_EQ(numbers[NumberId(i)], i);
  EXPECT_EQ(numbers.end_id(), NumberId(1000));
}

}  // namespace
}  // namespace prehend::grammar

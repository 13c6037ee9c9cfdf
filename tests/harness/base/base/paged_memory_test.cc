// SPDX-License-Identifier: Apache-2.0
#include "harness/base/base/paged_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <numeric>

namespace prehend {
namespace {

/// What of this process is in memory.
std::size_t BytesInMemory() {
  std::size_t all = 0, there = 0;
  std::ifstream("/proc/self/statm") >> all >> there;
  return there * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(PagedVector, KeepsWhatItLetsGoOf) {
  constexpr std::size_t kCount = 4 << 20, kBytes = kCount * sizeof(std::uint64_t);
  const std::size_t before = BytesInMemory();
  PagedVector<std::uint64_t> all(kCount);
  std::iota(all.begin(), all.end(), std::uint64_t{1});
  EXPECT_GT(BytesInMemory(), before + kBytes / 2);
  LetGo(all);
  EXPECT_LT(BytesInMemory(), before + kBytes / 8);
  for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(all[i], i + 1);
  all[7] = 3;
  LetGo(all);
  EXPECT_EQ(all[7], 3) << "what is written after that, too";
}

TEST(PagedVector, OfFewIsUsualMemory) {
  PagedVector<int> few = {3, 1, 4};
  LetGo(few);
  few.push_back(1);
  EXPECT_EQ(few, (PagedVector<int>{3, 1, 4, 1}));
}

TEST(PagedVector, Grows) {
  PagedVector<int> all;
  for (int i = 0; i < 1'000'000; ++i) {
    all.push_back(i);
    if (i % 4096 == 1) LetGo(all);
  }
  const PagedVector<int> other = all;
  all.erase(all.begin(), all.begin() + 10);
  EXPECT_EQ(all.front(), 10);
  EXPECT_EQ(std::accumulate(other.begin(), other.end(), std::int64_t{0}), 499'999'500'000);
}

}  // namespace
}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/show/pictures/pictures.h"

namespace prehend::show {
namespace {

TEST(Film, FramesAreEvenlyInTheEpisode) {
  const auto times_s = FrameTimes({.from_s = 1, .to_s = 2, .frames_per_s = 4, .speed = 0.5});
  ASSERT_EQ(times_s.size(), 9u);
  EXPECT_EQ(times_s.front(), 1);
  EXPECT_DOUBLE_EQ(times_s[1], 1.125);
  EXPECT_DOUBLE_EQ(times_s.back(), 2);
  EXPECT_EQ(FrameTimes({.from_s = 1, .to_s = 1.01, .frames_per_s = 10}).size(), 1u);
}

TEST(Film, OfTooManyFramesIsRefused) {
  EXPECT_EQ(WhyTooLong({.from_s = 0, .to_s = 99.9, .frames_per_s = 30}), "");
  EXPECT_EQ(WhyTooLong({.from_s = 0, .to_s = 100, .frames_per_s = 30}),
            "found 3001 frames, wanted at most 3000; choose a part with --from and --to, a lower "
            "--fps or a higher --speed");
}

TEST(Film, IsNamedByWhatItBecomes) {
  const std::string folder = testing::TempDir();
  EXPECT_EQ(WhyNoFilm(folder + "/a.webp"), "");
  EXPECT_EQ(WhyNoFilm(folder + "/a.mp4"), "");
  EXPECT_EQ(WhyNoFilm("a.gif"),
            "found 'a.gif', wanted NAME.webp, NAME.mp4, or a folder for the "
            "frames");
}

}  // namespace
}  // namespace prehend::show

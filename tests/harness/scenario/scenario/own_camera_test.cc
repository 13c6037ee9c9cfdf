// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/scenario/scenario/scenario.h"

namespace prehend::scenario {
namespace {

TEST(OwnCamera, IsAPlaceAndWhatItLooksAt) {
  const auto camera = ParseOwnCamera("0.9,-0.8,1.3:0.2,-0.1,0.9");
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->eye_m, Eigen::Vector3d(0.9, -0.8, 1.3));
  EXPECT_EQ(camera->look_at_m, Eigen::Vector3d(0.2, -0.1, 0.9));
  EXPECT_EQ(camera->view_deg, 33);
  EXPECT_EQ(ParseOwnCamera("1,0,0:0,0,0:60")->view_deg, 60);
}

TEST(OwnCamera, NothingElseIsOne) {
  for (const char* text : {"", "top", "1,0,0", "1,0,0:", "1,0,0:0,0", "1,0,0:0,0,0:",
                           "1,0,0:0,0,0:4", "1,0,0:0,0,0:121", "1,0,0:0,0,0:60x", "1,0,0:1,0,0",
                           "nan,0,0:0,0,0", "101,0,0:0,0,0", "1, 0,0:0,0,0", "1;0;0:0,0,0"})
    EXPECT_FALSE(ParseOwnCamera(text)) << text;
}

}  // namespace
}  // namespace prehend::scenario

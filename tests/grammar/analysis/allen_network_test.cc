// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/analysis/contradictions.h"
#include "grammar/base/allen.h"

namespace prehend::grammar {
namespace {

TEST(Allen, NamesTheThirteenRelations) {
  const Interval b{10, 20};
  const std::array<Interval, 13> in_order = {{{1, 5},
                                              {1, 10},
                                              {5, 15},
                                              {10, 15},
                                              {12, 18},
                                              {15, 20},
                                              {10, 20},
                                              {5, 20},
                                              {5, 25},
                                              {10, 25},
                                              {15, 25},
                                              {20, 25},
                                              {21, 25}}};
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    EXPECT_EQ(Relate(in_order[i], b), static_cast<Allen>(i)) << kAllenNames[i];
    EXPECT_EQ(AllenNamed(kAllenNames[i]), static_cast<Allen>(i));
  }
  EXPECT_FALSE(AllenNamed("befor"));
}

// Reading a pair backwards gives the converse, which is the relation mirrored in the enumeration.
TEST(Allen, ConversesMirror) {
  for (Tick ab = 0; ab < 5; ++ab) {
    for (Tick ae = ab + 1; ae < 6; ++ae) {
      for (Tick bb = 0; bb < 5; ++bb) {
        for (Tick be = bb + 1; be < 6; ++be) {
          const int forwards = static_cast<int>(Relate({ab, ae}, {bb, be}));
          EXPECT_EQ(static_cast<int>(Relate({bb, be}, {ab, ae})), 12 - forwards);
        }
      }
    }
  }
}

TEST(Allen, RelationsCompose) {
  EXPECT_EQ(Composed(Bit(Allen::kBefore), Bit(Allen::kBefore)), Bit(Allen::kBefore));
  EXPECT_EQ(Composed(Bit(Allen::kMeets), Bit(Allen::kDuring)),
            Bit(Allen::kOverlaps) | Bit(Allen::kStarts) | Bit(Allen::kDuring));
  EXPECT_EQ(Composed(Bit(Allen::kBefore), Bit(Allen::kAfter)), kAnyRelation);
  EXPECT_EQ(Inverse(Bit(Allen::kMeets) | Bit(Allen::kDuring)),
            Bit(Allen::kMetBy) | Bit(Allen::kContains));
}

TEST(Allen, NetworksAreRefusedThatCannotBe) {
  AllenNetwork circle(3);
  EXPECT_TRUE(circle.Constrain(0, 1, Bit(Allen::kBefore) | Bit(Allen::kMeets)));
  EXPECT_TRUE(circle.Constrain(1, 2, Bit(Allen::kBefore)));
  EXPECT_FALSE(circle.Constrain(2, 0, Bit(Allen::kBefore) | Bit(Allen::kOverlaps)));
  AllenNetwork fits(3);
  EXPECT_TRUE(fits.Constrain(0, 1, Bit(Allen::kContains)));
  EXPECT_TRUE(fits.Constrain(1, 2, Bit(Allen::kContains)));
  EXPECT_TRUE(fits.Constrain(0, 2, Bit(Allen::kContains) | Bit(Allen::kBefore)));
  EXPECT_FALSE(fits.Constrain(2, 0, Bit(Allen::kAfter)));
  EXPECT_FALSE(AllenNetwork(1).Constrain(0, 0, Bit(Allen::kBefore)));
}

}  // namespace
}  // namespace prehend::grammar

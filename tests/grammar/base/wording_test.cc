// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/base/diagnostic.h"

namespace prehend::grammar {
namespace {

TEST(Wording, ACountHasItsNoun) {
  EXPECT_EQ(CountOf(1, "row"), "1 row");
  EXPECT_EQ(CountOf(0, "row"), "0 rows");
  EXPECT_EQ(CountOf(2, "faulty line"), "2 faulty lines");
  EXPECT_EQ(CountOf(2, "entity"), "2 entities");
  EXPECT_EQ(CountOf(2, "key"), "2 keys");
  EXPECT_EQ(CountOf(3, "class"), "3 classes");
  EXPECT_EQ(CountOf(3, "sketch"), "3 sketches");
  EXPECT_EQ(Plural(1, "step"), "step");
}

TEST(Wording, AnArticleFitsItsNoun) {
  EXPECT_EQ(WithArticle("Thing"), "a Thing");
  EXPECT_EQ(WithArticle("Object"), "an Object");
  EXPECT_EQ(WithArticle("8 cm cube"), "an 8 cm cube");
}

}  // namespace
}  // namespace prehend::grammar

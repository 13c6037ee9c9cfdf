// SPDX-License-Identifier: Apache-2.0
// Equal bytes have equal hashes, other bytes others; of files and of the running program alike.
#include "harness/base/base/content_hash.h"

#include <gtest/gtest.h>

#include <fstream>

namespace prehend {
namespace {

TEST(ContentHash, IsXxh3) {
  EXPECT_EQ(ContentHash(""), "2d06800538d394c2");  // the published value
  EXPECT_EQ(ContentHash("foobar").size(), 16u);
  EXPECT_NE(ContentHash("foobar"), ContentHash("foobaz"));
  EXPECT_NE(ContentHash(std::string_view("a\0", 2)), ContentHash("a"));
}

TEST(ContentHash, OfAFileIsThatOfItsBytes) {
  const std::string path = testing::TempDir() + "content_hash_test";
  std::ofstream(path, std::ios::binary) << "a\r\nb";
  EXPECT_EQ(FileHash(path), ContentHash("a\r\nb"));
  EXPECT_EQ(FileHash("/no/such/file"), "none");
  std::string large;  // it is read in pieces
  for (int i = 0; i < 200'000; ++i) large += static_cast<char>(i * 7);
  std::ofstream(path + "_large", std::ios::binary) << large;
  EXPECT_EQ(FileHash(path + "_large"), ContentHash(large));
  EXPECT_EQ(HashFiles({path, "/no/such/file"}),
            (FileHashes{{path, ContentHash("a\r\nb")}, {"/no/such/file", "none"}}));
}

TEST(ContentHash, OfTheProgramStays) {
  EXPECT_EQ(ProgramHash(), ProgramHash());
  EXPECT_EQ(ProgramHash().size(), 16u);
}

}  // namespace
}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// The inner rooms: every include follows an arrow of the table, no arrows and no units form a
// circle, and no room grows into a warehouse. The checker is tested on made-up trees.
#include "tests/architecture/inner_rooms.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

constexpr int kMaxFilesPerRoom = 30;
const std::vector<std::string> kTopRooms = {"grammar", "physics", "render", "harness"};

bool IsOurs(const std::string& header) {
  for (const std::string& room : kTopRooms) {
    if (header.starts_with(room + "/")) return true;
  }
  return false;
}

/// A .h with its .cc.
std::string UnitOf(const std::string& path) { return path.substr(0, path.rfind('.')); }

/// Includes that no arrow allows, as sentences with the line.
std::vector<std::string> Violations(const std::vector<SourceFile>& files, const Arrows& arrows) {
  std::vector<std::string> found;
  for (const SourceFile& file : files) {
    const std::string room = InnerRoomOf(file.path);
    if (!arrows.contains(room)) {
      found.push_back(file.path + ": the room " + room + " is not in the table");
      continue;
    }
    for (const Include& include : IncludesOf(file.text)) {
      const std::string other = InnerRoomOf(include.header);
      if (!IsOurs(include.header) || other == room || arrows.at(room).contains(other)) continue;
      found.push_back(file.path + ":" + std::to_string(include.line) + ": " + room +
                      " must not include " + include.header);
    }
  }
  return found;
}

/// What includes what, from unit to unit.
Arrows UnitArrows(const std::vector<SourceFile>& files) {
  Arrows arrows;
  for (const SourceFile& file : files) {
    auto& targets = arrows[UnitOf(file.path)];
    for (const Include& include : IncludesOf(file.text)) {
      if (IsOurs(include.header) && UnitOf(include.header) != UnitOf(file.path))
        targets.insert(UnitOf(include.header));
    }
  }
  return arrows;
}

TEST(InnerRooms, EveryIncludeFollowsAnArrow) {
  const auto files = SourceFiles(kTopRooms);
  ASSERT_GT(files.size(), 300u) << "the source tree was not found";
  for (const std::string& violation : Violations(files, ProjectArrows()))
    ADD_FAILURE() << violation;
}

TEST(InnerRooms, FormNoCircle) { EXPECT_EQ(CircleIn(ProjectArrows()), ""); }

TEST(Wings, HaveTheArrowsOfTheirRooms) {
  Arrows used;
  for (const auto& [room, targets] : ProjectArrows()) {
    used[WingOf(room)];
    for (const std::string& target : targets)
      if (WingOf(target) != WingOf(room)) used[WingOf(room)].insert(WingOf(target));
  }
  EXPECT_EQ(used, WingArrows());
  EXPECT_EQ(CircleIn(WingArrows()), "");
  for (const auto& [wing, targets] : used) {
    std::string line = wing;
    for (const std::string& other : targets)
      line += (other == *targets.begin() ? " -> " : ", ") + other;
    std::puts(line.c_str());
  }
}

TEST(InnerRooms, UnitsFormNoCircle) { EXPECT_EQ(CircleIn(UnitArrows(SourceFiles(kTopRooms))), ""); }

/// Prints the table as it is used: each room, its files, and the rooms that it includes.
TEST(InnerRooms, HoldAtMostThirtyFilesAndAreAllUsed) {
  std::map<std::string, int> sizes;
  Arrows used;
  for (const SourceFile& file : SourceFiles(kTopRooms)) {
    const std::string room = InnerRoomOf(file.path);
    ++sizes[room];
    for (const Include& include : IncludesOf(file.text)) {
      const std::string other = InnerRoomOf(include.header);
      if (IsOurs(include.header) && other != room) used[room].insert(other);
    }
  }
  for (const auto& [room, size] : sizes) {
    std::string line = room + " (" + std::to_string(size) + " files)";
    for (const std::string& other : used[room])
      line += (other == *used[room].begin() ? " -> " : ", ") + other;
    std::puts(line.c_str());
    EXPECT_LE(size, kMaxFilesPerRoom) << room;
  }
  for (const auto& [room, targets] : ProjectArrows()) {
    EXPECT_TRUE(sizes.contains(room)) << "the table lists " << room << ", which has no files";
    for (const std::string& target : targets)
      EXPECT_TRUE(used[room].contains(target))
          << "the table allows " << room << " -> " << target << ", which nothing uses";
  }
}

TEST(InnerRoomsChecker, RefusesAnIncludeWithoutAnArrow) {
  const Arrows arrows = {{"harness/episode/run", {"harness/base/base"}}, {"harness/base/base", {}}};
  const std::vector<SourceFile> files = {
      {"harness/episode/run/a.h", "#include \"harness/base/base/b.h\"\n#include <vector>\n"},
      {"harness/base/base/b.h", "\n#include \"harness/episode/run/a.h\"\n"},
      {"harness/attic/c.h", ""}};
  EXPECT_EQ(
      Violations(files, arrows),
      (std::vector<std::string>{
          "harness/base/base/b.h:2: harness/base/base must not include harness/episode/run/a.h",
          "harness/attic/c.h: the room harness/attic is not in the table"}));
}

TEST(InnerRoomsChecker, FindsACircleOfRooms) {
  EXPECT_EQ(CircleIn({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), "b -> c -> b");
  EXPECT_EQ(CircleIn({{"a", {"b", "c"}}, {"b", {"c"}}, {"c", {}}}), "");
}

TEST(InnerRoomsChecker, FindsACircleOfUnits) {
  const std::vector<SourceFile> files = {{"grammar/x.h", "#include \"grammar/y.h\"\n"},
                                         {"grammar/y.h", ""},
                                         {"grammar/y.cc", "#include \"grammar/x.h\"\n"}};
  EXPECT_EQ(CircleIn(UnitArrows(files)), "grammar/x -> grammar/y -> grammar/x");
}

}  // namespace
}  // namespace prehend::architecture

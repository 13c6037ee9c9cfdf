// SPDX-License-Identifier: Apache-2.0
// Episodes drawn as rows of characters over time, with the events that must be recognised in them:
// unit tests of rules. docs/drawings.md describes the notation. Tested by
// tests/grammar/drawing/read_drawings_test.cc
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/frame.h"
#include "grammar/base/source.h"
#include "grammar/base/timeline.h"

namespace prehend::grammar {

inline constexpr Tick kDrawnTicksPerSecond = 3600;
inline constexpr Tick kDrawnColumnTicks = kDrawnTicksPerSecond / 20;  ///< 50 ms

struct DrawnRow {
  std::string name;   ///< "cup on table", "hand grip", "grasping(hand, cup)"
  std::string cells;  ///< one character per column
  int line = 0;       ///< in its file
};

struct DrawnEpisode {
  std::string title;       ///< may be empty
  int line = 0;            ///< where it begins
  std::string grammar;     ///< that it is for; may be empty
  bool jittered = false;   ///< frames come after 4 to 16 ms
  std::vector<int> rates;  ///< frames per second, if several are to give the same
  std::vector<EntityInfo> entity_table;
  std::vector<DrawnRow> facts;
  std::vector<DrawnRow> expected;
  bool has_expected = false;  ///< there is a line `--`

  Tick end() const { return kDrawnColumnTicks * static_cast<Tick>(facts.front().cells.size()); }
};

/// All episodes of a file; none if something is wrong with it. Each has a row of facts, all its
/// rows have the same length, and every fact can be shown.
std::vector<DrawnEpisode> ReadDrawings(const GrammarText& file, Diagnostics& diagnostics);

/// Shows what is drawn, frame by frame.
class DrawnFrames {
 public:
  /// `drawn` outlives this.
  explicit DrawnFrames(const DrawnEpisode& drawn) : drawn_(drawn) {}
  /// What holds at this tick; lives until the next call. Bodies are points, and so are hands.
  Frame At(Tick tick);
  /// From one frame to the next.
  Tick StepAfter(int frame, int frames_per_second) const;

 private:
  int Id(const std::string& name) const;
  void Apply(const DrawnRow& row, Tick tick);
  void ApplyPair(int a, int b, const std::string& what, char cell);
  void AddTouch(int a, int b, const std::string& how, char cell);
  Touch& TouchOf(int a, int b);

  const DrawnEpisode& drawn_;
  std::vector<EntitySample> looks_;
  std::vector<CollisionSphere> collision_spheres_;
  std::vector<HandSample> hands_;
  std::vector<Touch> touches_;
};

/// Events drawn as rows, in the order in which they first begin; of the `background` only those of
/// which the episode expects some.
std::vector<DrawnRow> DrawEvents(const DrawnEpisode& drawn, const Timeline& timeline,
                                 const std::vector<std::string>& background);

/// A line per row.
std::string Text(const std::vector<DrawnRow>& rows);

}  // namespace prehend::grammar

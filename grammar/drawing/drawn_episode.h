// SPDX-License-Identifier: Apache-2.0
// Episodes drawn as rows of characters over time, with the events that must be recognised in them:
// unit tests of rules. docs/drawings.md describes the notation. Tested by
// tests/grammar/drawing/read_drawings_test.cc
#pragma once

#include <optional>
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

// What a row of a drawing can say, of whom, and with which characters. docs/drawings.md lists it.

struct DrawnFact {
  std::string name;
  bool of_two = false;          ///< "cup on table"
  int most = -1;                ///< its characters stand for 0 to this number; -1: for none
  bool marks = false;           ///< '#' may stand in it
  bool says_all_along = false;  ///< in each column: '.' is 0 there, else it says nothing

  bool Takes(char cell) const;
  bool Says(char cell) const { return says_all_along || cell != '.'; }
  /// "0..9, a..k or '.'"
  std::string Characters() const;
};

/// 0..9, then a = 10 .. z = 35; of any other character nothing.
std::optional<int> DrawnNumber(char cell);

/// What can be said of an entity; a hand has a fact for each of its sensor sets.
std::vector<DrawnFact> FactsOf(const EntityInfo& entity);

/// Why this can never be said of the entity; empty: it can.
std::string WhyNever(const DrawnFact& fact, const EntityInfo& entity);

/// The values that the fact sets, named so that two facts that set the same one have the same name:
/// "cup x", "cup table lie". At most one row can do so in a column.
std::vector<std::string> ValuesSetBy(const DrawnFact& fact, const std::string& who,
                                     const std::string& whom);

}  // namespace prehend::grammar

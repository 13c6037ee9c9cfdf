// SPDX-License-Identifier: Apache-2.0
// What of a file of poses does not look as its map says: unit, axes, order of quaternions, times,
// places, handedness. A guess is an error only if two signs that do not depend on each other agree;
// one alone is a warning with both readings. docs/motion-capture.md has how often each is wrong.
// Tested by tests/program/import_test.cc and tests/program/import_warnings_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/exchange/doubts/motion_seen.h"
#include "harness/exchange/doubts/rest_poses.h"

namespace prehend::exchange {

/// The signs of one guess, each a sentence with the numbers that were seen.
struct Guess {
  Where where;  ///< of the key of the map that looks wrong
  Warning kind = Warning::kUnit;
  std::vector<std::string> signs;  ///< of each independent family one
  std::string remedy;              ///< for the map
  bool is_certain = false;         ///< the file and the map contradict each other

  std::string Text() const;
  std::string Remedy() const;
};

struct Implausible {
  grammar::Diagnostics errors;
  std::vector<std::string> warnings;
  bool unit = false;   ///< it looks wrong: nothing else is to be guessed from lengths
  bool world = false;  ///< axes or handedness do: where things are means nothing
};

/// None of a kind that the map is sure about.
Implausible FindImplausible(const PoseFile& poses, const MapFile& map);

/// One for each guess: they have no signs if all is as the map says.
Guess GuessUnit(const PoseFile& poses, const ImportMap& map);
Guess GuessPlace(const PoseFile& poses, const ImportMap& map);
/// `any_sign`: one is enough, where nothing was said before.
Guess GuessAxes(const PoseFile& poses, const ImportMap& map, bool any_sign = false);
/// Whether nothing is lifted along up, but something along no axis of the file; or "".
std::string LiftedAskew(const PoseFile& poses, const ImportMap& map);
Guess GuessOrder(const PoseFile& poses, const ImportMap& map);
Guess GuessAngleUnit(const PoseFile& poses, const ImportMap& map);
Guess GuessHandedness(const PoseFile& poses, const ImportMap& map);

/// What grippers carry far off their origins, and what looks exchanged with a hand, each a line.
std::vector<std::string> OddlyHeld(const PoseFile& poses, const ImportMap& map);

/// What a hand cannot move.
DoubtfulThings ThingsTooLarge(const ImportMap& map);

/// Where the map says which body is read first.
const Where& FirstBodyWhere(const ImportMap& map);

/// How near what is tracked comes to what the map places.
struct Approach {
  double distance_m = INFINITY;
  const Named<MappedEntity>* place = nullptr;
  const PoseBody* comes = nullptr;
};
Approach NearestApproach(const PoseFile& poses, const ImportMap& map, double metres_per_unit);

/// What looks wrong in the numbers that say how far a gripper or a joint is open.
struct OpeningDoubt {
  std::string text;  ///< "": nothing looks wrong
  std::string hint;
  bool is_error = false;
};

/// Values far beyond open and closed: of the most an error, of some a warning. A gripper that
/// hardly moves is a warning, too. `file`: what messages call the file.
OpeningDoubt JudgeOpening(const OpeningSeries& series, const Opening& said,
                          const std::string& file);

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
// The seven classes and the few facts about them.
#include "grammar/analysis/classes.h"

#include <algorithm>

namespace prehend::grammar {
namespace {

bool SaysHowItMoves(std::string_view name) {
  return name == "Movable" || name == "Fixed" || name == "Jointed" || name == "Attached";
}

}  // namespace

const std::vector<std::string>& BuiltinClasses() {
  static const std::vector<std::string> kClasses = {"Entity", "Hand",    "Thing",   "Movable",
                                                    "Fixed",  "Jointed", "Attached"};
  return kClasses;
}

bool IsBuiltinClass(std::string_view name) {
  return std::find(BuiltinClasses().begin(), BuiltinClasses().end(), name) !=
         BuiltinClasses().end();
}

bool ClassesMeet(std::string_view a, std::string_view b) {
  if (a == b || a == "Entity" || b == "Entity") return true;
  if (a == "Hand" || b == "Hand") return false;
  return !SaysHowItMoves(a) || !SaysHowItMoves(b);
}

bool ClassImplies(std::string_view a, std::string_view b) {
  return a == b || b == "Entity" || (b == "Thing" && SaysHowItMoves(a));
}

}  // namespace prehend::grammar

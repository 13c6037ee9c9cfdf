// SPDX-License-Identifier: Apache-2.0
// The inner rooms of the house and the arrows between them: what ARCHITECTURE.md draws, as a table.
#pragma once

#include <map>
#include <set>
#include <string>

namespace prehend::architecture {

/// An inner room (a folder; "harness/" style top rooms without inner ones count as one) and the
/// rooms whose headers its files may include besides its own. What is not listed is refused.
using Arrows = std::map<std::string, std::set<std::string>>;

/// The table of this project. `tests` and `bench` are not in it: they may include anything.
const Arrows& ProjectArrows();

/// The same between boxes of the drawing: the wings of harness, and the other top rooms whole.
const Arrows& WingArrows();

/// The box of an inner room: "harness/episode" of "harness/episode/run", "grammar" of
/// "grammar/engine".
std::string WingOf(const std::string& inner_room);

/// The inner room of a path: its folder, e.g. "physics/bullet/core" of
/// "physics/bullet/core/solver.h".
std::string InnerRoomOf(const std::string& path);

/// The rooms of one circle of arrows, in order, or nothing: "a -> b -> a".
std::string CircleIn(const Arrows& arrows);

}  // namespace prehend::architecture

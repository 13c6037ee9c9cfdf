// SPDX-License-Identifier: Apache-2.0
// See tests/architecture/inner_rooms.h. Tested by tests/architecture/inner_rooms_test.cc
#include "tests/architecture/inner_rooms.h"

#include <functional>
#include <vector>

namespace prehend::architecture {

const Arrows& ProjectArrows() {
  static const Arrows arrows = {
      {"grammar/base", {}},
      {"grammar/language", {"grammar/base"}},
      {"grammar/drawing", {"grammar/base"}},
      {"grammar/program", {"grammar/base"}},
      {"grammar/analysis", {"grammar/base", "grammar/program"}},
      {"grammar/compile",
       {"grammar/analysis", "grammar/base", "grammar/language", "grammar/program"}},
      {"grammar/state", {"grammar/base", "grammar/program"}},
      {"grammar/values", {"grammar/base", "grammar/state"}},
      {"grammar/engine", {"grammar/base", "grammar/program", "grammar/state", "grammar/values"}},
      {"grammar",
       {"grammar/analysis", "grammar/base", "grammar/compile", "grammar/drawing", "grammar/engine",
        "grammar/program", "grammar/state"}},

      {"physics/base", {}},
      {"physics/scene", {"physics/base"}},
      {"physics/motion", {"physics/base", "physics/scene"}},
      {"physics/world", {"physics/motion", "physics/scene"}},
      {"physics/hand", {"physics/motion", "physics/scene", "physics/world"}},
      {"physics/person", {"physics/motion", "physics/scene", "physics/world"}},
      {"physics/bullet/lanes", {}},
      {"physics/bullet/core", {"physics/bullet/lanes"}},
      {"physics/bullet",
       {"physics/base", "physics/bullet/core", "physics/hand", "physics/scene", "physics/world"}},
      {"physics/box2d", {"physics/base", "physics/hand", "physics/scene", "physics/world"}},
      {"physics",
       {"physics/box2d", "physics/bullet", "physics/hand", "physics/motion", "physics/person",
        "physics/scene", "physics/world"}},

      {"render/gl", {"physics/base", "physics/scene"}},
      {"render/image", {"physics/base"}},
      {"render", {"physics/base", "physics/scene", "render/gl", "render/image"}},

      {"harness/base/base", {"grammar/base"}},
      {"harness/base/process", {}},
      {"harness/truth/timeline", {"grammar", "grammar/base"}},
      // An evaluator of its own: it never sees what it judges.
      {"harness/truth/oracle", {"grammar/base", "physics/scene"}},
      {"harness/truth/claims",
       {"grammar", "grammar/base", "harness/base/base", "harness/truth/timeline"}},
      {"harness/scenario/scenario",
       {"grammar/base", "harness/base/base", "harness/truth/claims", "physics/base",
        "physics/motion", "physics/scene"}},
      {"harness/scenario/transform", {"harness/scenario/scenario"}},
      {"harness/base/yaml", {"harness/base/base"}},
      {"harness/truth/golden", {"grammar/base", "harness/base/base", "harness/truth/timeline"}},
      {"harness/scenario/motion",
       {"harness/base/base", "harness/base/yaml", "physics/base", "physics/motion"}},
      {"harness/episode/sense",
       {"grammar/base", "harness/base/base", "harness/scenario/scenario", "harness/base/yaml",
        "physics/base", "physics/scene"}},
      {"harness/scenario/format",
       {"harness/base/base", "harness/scenario/scenario", "harness/base/yaml", "physics/motion",
        "physics/scene"}},
      {"harness/scenario/resolve",
       {"harness/scenario/format", "harness/scenario/scenario", "harness/base/yaml", "physics/base",
        "physics/motion", "physics/person", "physics/scene"}},
      {"harness/scenario/read",
       {"harness/base/base", "harness/scenario/resolve", "harness/truth/claims",
        "harness/scenario/format", "harness/scenario/motion", "harness/scenario/scenario",
        "harness/base/yaml", "physics/base", "physics/person", "physics/scene"}},
      {"harness/episode/run",
       {"grammar", "grammar/base", "grammar/compile", "harness/base/base", "harness/truth/claims",
        "harness/scenario/format", "harness/base/process", "harness/scenario/read",
        "harness/scenario/scenario", "harness/episode/sense", "harness/truth/timeline",
        "harness/base/yaml", "physics", "physics/scene"}},
      {"harness/episode/frames",
       {"harness/base/base", "harness/episode/sense", "physics/base", "physics/scene"}},
      {"harness/episode/episodes",
       {"grammar", "grammar/base", "harness/base/base", "harness/episode/frames",
        "harness/scenario/read", "harness/episode/run", "harness/scenario/scenario",
        "harness/episode/sense", "physics", "physics/scene"}},
      {"harness/episode/episode",
       {"grammar", "harness/base/base", "harness/episode/episodes", "harness/base/process",
        "harness/base/yaml", "harness/episode/run", "harness/episode/sense",
        "harness/truth/timeline"}},
      {"harness/exchange/messages", {"harness/base/base"}},
      {"harness/exchange/hdf5", {"harness/base/base"}},
      {"harness/exchange/cells", {"harness/base/base"}},
      {"harness/exchange/poses",
       {"grammar/base", "harness/base/base", "harness/episode/sense", "harness/exchange/cells",
        "harness/exchange/hdf5", "harness/exchange/messages", "harness/base/yaml"}},
      {"harness/exchange/arrays",
       {"grammar/base", "harness/base/base", "harness/exchange/cells", "harness/exchange/hdf5",
        "harness/exchange/messages", "harness/exchange/poses", "harness/scenario/motion"}},
      {"harness/exchange/import",
       {"grammar/base", "harness/base/base", "harness/exchange/arrays", "harness/exchange/cells",
        "harness/exchange/poses", "harness/episode/sense", "harness/base/yaml"}},
      {"harness/exchange/live",
       {"harness/episode/sense", "harness/exchange/import", "harness/exchange/poses"}},
      {"harness/show/explain",
       {"grammar", "grammar/base", "grammar/program", "harness/base/base",
        "harness/episode/episode", "harness/truth/timeline"}},
      {"harness/show/pictures",
       {"harness/base/base", "harness/base/process", "harness/episode/run",
        "harness/scenario/scenario", "harness/truth/timeline", "physics/scene", "render"}},
      {"harness/show/chart", {"harness/base/base"}},
      {"harness/show/figures",
       {"harness/base/base", "harness/episode/episode", "harness/episode/episodes",
        "harness/show/chart", "harness/truth/golden", "harness/show/pictures",
        "harness/episode/run", "harness/scenario/scenario", "harness/truth/timeline",
        "physics/scene"}},
      {"harness/show/replay",
       {"harness/base/base", "harness/show/pictures", "harness/episode/run",
        "harness/scenario/scenario", "physics/base"}},
      {"harness/exchange/knowledge",
       {"grammar", "harness/base/base", "harness/episode/episode", "harness/episode/episodes",
        "harness/base/process", "harness/episode/run", "physics/base"}},
      {"harness/exchange/subtasks",
       {"grammar", "harness/base/base", "harness/base/yaml", "harness/episode/episode",
        "harness/exchange/export", "harness/exchange/hdf5", "harness/exchange/poses",
        "harness/truth/timeline"}},
      {"harness/exchange/export",
       {"grammar", "grammar/base", "harness/base/base", "harness/episode/episode",
        "harness/episode/episodes", "harness/scenario/scenario", "harness/truth/timeline",
        "physics/scene"}},
      {"harness/measure/recognise",
       {"harness/base/process", "harness/episode/sense", "harness/exchange/labels"}},
      {"harness/measure/score",
       {"grammar", "grammar/base", "harness/base/base", "harness/truth/claims",
        "harness/episode/episode", "harness/exchange/labels", "harness/measure/recognise",
        "harness/truth/oracle", "harness/base/process", "harness/episode/run",
        "harness/truth/timeline"}},
      {"harness/exchange/labels",
       {"grammar", "grammar/base", "harness/base/base", "harness/truth/golden",
        "harness/episode/episode", "harness/truth/timeline", "harness/base/yaml"}},
      {"harness/measure/sweep",
       {"grammar", "grammar/base", "harness/base/base", "harness/show/chart",
        "harness/episode/episode", "harness/truth/golden", "harness/exchange/labels",
        "harness/truth/oracle", "harness/base/process", "harness/episode/run",
        "harness/measure/score", "harness/truth/timeline"}},
      {"harness/measure/speed",
       {"grammar", "harness/episode/episode", "harness/episode/run", "harness/episode/sense"}},
      {"harness/suite/judge",
       {"grammar", "grammar/base", "harness/base/base", "harness/truth/claims",
        "harness/truth/golden", "harness/truth/oracle", "harness/show/figures",
        "harness/show/pictures", "harness/episode/episode", "harness/episode/run",
        "harness/scenario/scenario", "harness/episode/sense", "harness/truth/timeline",
        "harness/scenario/transform", "physics/scene"}},
      {"harness/suite/check",
       {"grammar", "harness/base/base", "harness/truth/claims", "harness/episode/episode",
        "harness/episode/episodes", "harness/show/explain", "harness/truth/golden",
        "harness/suite/judge", "harness/show/pictures", "harness/base/process",
        "harness/scenario/read", "harness/show/replay", "harness/episode/run",
        "harness/episode/sense", "harness/truth/timeline", "harness/base/yaml", "physics/scene"}},
      {"harness/suite/accept",
       {"harness/base/base", "harness/episode/episode", "harness/episode/run",
        "harness/scenario/read", "harness/show/pictures", "harness/suite/check",
        "harness/suite/judge", "harness/truth/golden"}},
      {"harness/scenario/templates", {"grammar/base", "harness/base/base", "harness/base/yaml"}},
      {"harness/suite/report",
       {"harness/base/base", "harness/show/chart", "harness/suite/check", "harness/truth/golden",
        "harness/base/process", "harness/truth/timeline"}},
      {"harness/library/library",
       {"grammar", "grammar/base", "harness/base/base", "harness/episode/episode",
        "harness/episode/run", "harness/episode/sense", "harness/exchange/labels",
        "harness/measure/score", "harness/measure/sweep", "harness/show/chart",
        "harness/show/explain", "harness/truth/timeline", "physics"}},
      {"harness/cli/command",
       {"grammar/base", "harness/base/base", "harness/episode/episode", "harness/show/figures",
        "harness/suite/judge", "harness/show/pictures", "harness/base/process",
        "harness/episode/run"}},
      {"harness/cli/daily",
       {"grammar",
        "harness/base/base",
        "harness/cli/command",
        "harness/episode/episode",
        "harness/episode/episodes",
        "harness/episode/run",
        "harness/exchange/import",
        "harness/measure/score",
        "harness/scenario/format",
        "harness/scenario/read",
        "harness/scenario/templates",
        "harness/show/explain",
        "harness/show/figures",
        "harness/show/pictures",
        "harness/suite/accept",
        "harness/suite/check",
        "harness/suite/judge",
        "harness/suite/report",
        "harness/truth/golden",
        "harness/truth/timeline"}},
      {"harness/cli/nouns",
       {"grammar",
        "harness/base/base",
        "harness/base/process",
        "harness/cli/command",
        "harness/episode/episode",
        "harness/episode/episodes",
        "harness/episode/run",
        "harness/episode/sense",
        "harness/exchange/export",
        "harness/exchange/live",
        "harness/exchange/poses",
        "harness/exchange/knowledge",
        "harness/exchange/labels",
        "harness/exchange/subtasks",
        "harness/measure/score",
        "harness/measure/speed",
        "harness/measure/sweep",
        "harness/scenario/format",
        "harness/show/explain",
        "harness/show/figures",
        "harness/show/pictures",
        "harness/suite/check",
        "harness/truth/golden",
        "harness/truth/timeline"}},
      {"harness/cli/cli", {"harness/base/base", "harness/cli/command"}},
  };
  return arrows;
}

const Arrows& WingArrows() {
  static const Arrows arrows = {
      {"grammar", {}},
      {"physics", {}},
      {"render", {"physics"}},
      {"harness/base", {"grammar"}},
      {"harness/truth", {"grammar", "harness/base", "physics"}},
      {"harness/scenario", {"grammar", "harness/base", "harness/truth", "physics"}},
      {"harness/episode",
       {"grammar", "harness/base", "harness/scenario", "harness/truth", "physics"}},
      {"harness/exchange",
       {"grammar", "harness/base", "harness/episode", "harness/scenario", "harness/truth",
        "physics"}},
      {"harness/show",
       {"grammar", "harness/base", "harness/episode", "harness/scenario", "harness/truth",
        "physics", "render"}},
      {"harness/measure",
       {"grammar", "harness/base", "harness/episode", "harness/exchange", "harness/show",
        "harness/truth"}},
      {"harness/suite",
       {"grammar", "harness/base", "harness/episode", "harness/scenario", "harness/show",
        "harness/truth", "physics"}},
      {"harness/library",
       {"grammar", "harness/base", "harness/episode", "harness/exchange", "harness/measure",
        "harness/show", "harness/truth", "physics"}},
      {"harness/cli",
       {"grammar", "harness/base", "harness/episode", "harness/exchange", "harness/measure",
        "harness/scenario", "harness/show", "harness/suite", "harness/truth"}},
  };
  return arrows;
}

std::string WingOf(const std::string& inner_room) {
  const bool in_harness = inner_room.starts_with("harness/");
  return inner_room.substr(0, inner_room.find('/', in_harness ? sizeof("harness/") - 1 : 0));
}

std::string InnerRoomOf(const std::string& path) { return path.substr(0, path.rfind('/')); }

std::string CircleIn(const Arrows& arrows) {
  std::set<std::string> finished;
  std::vector<std::string> way;
  const std::function<std::string(const std::string&)> visit = [&](const std::string& room) {
    for (std::size_t i = 0; i < way.size(); ++i) {
      if (way[i] != room) continue;
      std::string circle;
      for (; i < way.size(); ++i) circle += way[i] + " -> ";
      return circle + room;
    }
    if (!finished.insert(room).second || !arrows.contains(room)) return std::string();
    way.push_back(room);
    for (const std::string& next : arrows.at(room)) {
      if (std::string circle = visit(next); !circle.empty()) return circle;
    }
    way.pop_back();
    return std::string();
  };
  for (const auto& [room, ignored] : arrows) {
    if (std::string circle = visit(room); !circle.empty()) return circle;
  }
  return "";
}

}  // namespace prehend::architecture

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
      {"grammar/compile", {"grammar/base", "grammar/language", "grammar/program"}},
      {"grammar/engine", {"grammar/base", "grammar/program"}},
      {"grammar",
       {"grammar/base", "grammar/compile", "grammar/drawing", "grammar/engine", "grammar/program"}},

      {"physics/scene", {}},
      {"physics/motion", {"physics/scene"}},
      {"physics/world", {"physics/motion", "physics/scene"}},
      {"physics/hand", {"physics/motion", "physics/scene", "physics/world"}},
      {"physics/person", {"physics/motion", "physics/scene", "physics/world"}},
      {"physics/bullet/lanes", {}},
      {"physics/bullet/core", {"physics/bullet/lanes"}},
      {"physics/bullet", {"physics/bullet/core", "physics/hand", "physics/scene", "physics/world"}},
      {"physics/box2d", {"physics/hand", "physics/scene", "physics/world"}},
      {"physics",
       {"physics/box2d", "physics/bullet", "physics/hand", "physics/motion", "physics/person",
        "physics/scene", "physics/world"}},

      {"render/gl", {"physics/scene"}},
      {"render", {"physics/scene", "render/gl"}},

      {"harness/base", {"grammar/base"}},
      {"harness/process", {}},
      {"harness/timeline", {"grammar", "grammar/base"}},
      // A witness of its own: it never sees what it judges.
      {"harness/oracle", {"grammar/base", "physics/scene"}},
      {"harness/claims", {"grammar", "grammar/base", "harness/base", "harness/timeline"}},
      {"harness/scenario",
       {"grammar/base", "harness/base", "harness/claims", "physics/motion", "physics/scene"}},
      {"harness/transform", {"harness/scenario"}},
      {"harness/yaml", {"harness/base"}},
      {"harness/golden", {"grammar/base", "harness/base", "harness/timeline"}},
      {"harness/motion", {"harness/base", "harness/yaml", "physics/motion", "physics/scene"}},
      {"harness/sense",
       {"grammar/base", "harness/base", "harness/scenario", "harness/yaml", "physics/scene"}},
      {"harness/format",
       {"harness/base", "harness/scenario", "harness/yaml", "physics/motion", "physics/scene"}},
      {"harness/build",
       {"harness/format", "harness/scenario", "harness/yaml", "physics/motion", "physics/person",
        "physics/scene"}},
      {"harness/read",
       {"harness/base", "harness/build", "harness/claims", "harness/format", "harness/motion",
        "harness/scenario", "harness/yaml", "physics/person", "physics/scene"}},
      {"harness/run",
       {"grammar", "grammar/base", "grammar/compile", "harness/base", "harness/claims",
        "harness/format", "harness/process", "harness/read", "harness/scenario", "harness/sense",
        "harness/timeline", "harness/yaml", "physics", "physics/scene"}},
      {"harness/frames", {"harness/sense", "physics/scene"}},
      {"harness/episodes",
       {"grammar", "grammar/base", "harness/base", "harness/frames", "harness/read", "harness/run",
        "harness/scenario", "harness/sense", "physics", "physics/scene"}},
      {"harness/episode",
       {"grammar", "harness/base", "harness/episodes", "harness/process", "harness/run",
        "harness/sense", "harness/timeline"}},
      {"harness/messages", {"harness/base"}},
      {"harness/import",
       {"grammar/base", "harness/base", "harness/messages", "harness/motion", "harness/sense",
        "harness/yaml"}},
      {"harness/explain",
       {"grammar", "grammar/base", "grammar/program", "harness/base", "harness/episode",
        "harness/timeline"}},
      {"harness/pictures",
       {"harness/base", "harness/process", "harness/run", "harness/scenario", "harness/timeline",
        "physics/scene", "render"}},
      {"harness/chart", {"harness/base"}},
      {"harness/figures",
       {"harness/base", "harness/chart", "harness/golden", "harness/pictures", "harness/run",
        "harness/scenario", "harness/timeline", "physics/scene"}},
      {"harness/replay",
       {"harness/base", "harness/pictures", "harness/run", "harness/scenario", "physics/scene"}},
      {"harness/knowledge",
       {"grammar", "harness/base", "harness/episode", "harness/episodes", "harness/process",
        "harness/run", "physics/scene"}},
      {"harness/score",
       {"grammar", "grammar/base", "harness/base", "harness/claims", "harness/episode",
        "harness/labels", "harness/oracle", "harness/process", "harness/run", "harness/timeline"}},
      {"harness/labels",
       {"grammar", "grammar/base", "harness/base", "harness/golden", "harness/run",
        "harness/timeline", "harness/yaml"}},
      {"harness/sweep",
       {"grammar", "grammar/base", "harness/base", "harness/chart", "harness/episode",
        "harness/golden", "harness/labels", "harness/oracle", "harness/process", "harness/run",
        "harness/score", "harness/timeline"}},
      {"harness/speed", {"grammar", "harness/episode", "harness/run", "harness/sense"}},
      {"harness/judge",
       {"grammar", "grammar/base", "harness/base", "harness/claims", "harness/golden",
        "harness/oracle", "harness/pictures", "harness/run", "harness/scenario", "harness/sense",
        "harness/timeline", "harness/transform", "physics/scene"}},
      {"harness/check",
       {"grammar", "harness/base", "harness/claims", "harness/episode", "harness/episodes",
        "harness/explain", "harness/golden", "harness/judge", "harness/pictures", "harness/process",
        "harness/read", "harness/replay", "harness/run", "harness/sense", "harness/timeline",
        "harness/yaml", "physics/scene"}},
      {"harness/templates", {"grammar/base", "harness/base", "harness/yaml"}},
      {"harness/report",
       {"harness/base", "harness/chart", "harness/check", "harness/golden", "harness/process",
        "harness/timeline"}},
      {"harness/command",
       {"grammar/base", "harness/base", "harness/episode", "harness/episodes", "harness/figures",
        "harness/golden", "harness/judge", "harness/pictures", "harness/process", "harness/run",
        "harness/sense"}},
      {"harness/cli",
       {"grammar",           "harness/base",     "harness/check",    "harness/command",
        "harness/episode",   "harness/episodes", "harness/explain",  "harness/figures",
        "harness/format",    "harness/golden",   "harness/import",   "harness/judge",
        "harness/knowledge", "harness/labels",   "harness/pictures", "harness/process",
        "harness/read",      "harness/report",   "harness/run",      "harness/score",
        "harness/sense",     "harness/speed",    "harness/sweep",    "harness/templates",
        "harness/timeline"}},
  };
  return arrows;
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

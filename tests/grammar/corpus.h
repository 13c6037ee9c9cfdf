// SPDX-License-Identifier: Apache-2.0
// Corpus cases: what happens, drawn as rows of characters over time, and the events that must come
// of it. The notation is described at the head of tests/grammar/corpus/pick_and_place.txt.
#pragma once

#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/monitor.h"

namespace prehend::grammar::testing {

inline constexpr Tick kCorpusTicksPerSecond = 3600;
inline constexpr Tick kCorpusColumnTicks = kCorpusTicksPerSecond / 20;

struct Row {
  std::string name;   ///< "cup on table", "hand grip", "grasping(hand, cup)"
  std::string cells;  ///< one character per column
};

struct CorpusCase {
  std::string title;
  int line = 0;
  std::string grammar = "pick_and_place";
  bool jittered = false;
  std::vector<int> rates;  ///< frames per second, if several are to give the same
  std::vector<EntityInfo> entity_table;
  std::vector<Row> facts;
  std::vector<Row> expected;
};

/// Reads a corpus file; aborts with a message on malformed ones.
std::vector<CorpusCase> ReadCorpus(const std::string& path);
std::vector<CorpusCase> ReadCorpusText(const std::string& path, const std::string& text);

/// What the engine makes of a case.
struct CorpusRun {
  std::string error;
  Timeline timeline;
};
CorpusRun RunCase(const CorpusCase& corpus_case, int frames_per_second = 100);
/// The same with another grammar than the case names.
CorpusRun RunCase(const CorpusCase& corpus_case, const std::shared_ptr<const Program>& program,
                  int frames_per_second = 100);

/// Events of the kinds that the case is about, drawn as rows, sorted by first begin.
std::vector<Row> DrawEvents(const CorpusCase& corpus_case, const Timeline& timeline);
std::string Text(const std::vector<Row>& rows);

std::string ReadFile(const std::string& path);
/// A grammar of grammar/library, compiled; aborts when there are errors.
std::shared_ptr<const Program> CompileLibrary(const std::string& name,
                                              const Overrides& overrides = {});
Includer LibraryIncluder();

}  // namespace prehend::grammar::testing

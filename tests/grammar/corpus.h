// SPDX-License-Identifier: Apache-2.0
// Corpus cases: what happens, drawn as rows of characters over time, and the events that must come
// of it. The notation is described at the head of tests/grammar/corpus/pick_and_place.txt.
#pragma once

#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/drawing/drawn_episode.h"
#include "grammar/monitor.h"
#include "grammar/watch_drawing.h"

namespace prehend::grammar::testing {

inline constexpr Tick kCorpusTicksPerSecond = kDrawnTicksPerSecond;
inline constexpr Tick kCorpusColumnTicks = kDrawnColumnTicks;
using Row = DrawnRow;
using CorpusCase = DrawnEpisode;
using CorpusRun = WatchedDrawing;

/// Reads a corpus file; aborts with a message on malformed ones.
std::vector<CorpusCase> ReadCorpus(const std::string& path);
std::vector<CorpusCase> ReadCorpusText(const std::string& path, const std::string& text);

/// What the engine makes of a case.
CorpusRun RunCase(const CorpusCase& corpus_case, int frames_per_second = 100);
/// The same with another grammar than the case names.
CorpusRun RunCase(const CorpusCase& corpus_case, const std::shared_ptr<const Program>& program,
                  int frames_per_second = 100);

std::string ReadFile(const std::string& path);
/// A grammar of grammar/library, compiled; aborts when there are errors.
std::shared_ptr<const Program> CompileLibrary(const std::string& name,
                                              const Overrides& overrides = {});
Includer LibraryIncluder();

}  // namespace prehend::grammar::testing

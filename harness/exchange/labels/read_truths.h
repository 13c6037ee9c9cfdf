// SPDX-License-Identifier: Apache-2.0
// From takes and the options of a command to their labels. Tested by tests/program/labels_test.cc
// and tests/program/takes_test.cc
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/base/base/result.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"
#include "harness/episode/episode/take.h"
#include "harness/exchange/labels/label_map.h"

namespace prehend::exchange {

/// `given`: files of labels, one of all takes, or a folder, for takes that name none; `map`: a
/// file, or "" for that of the takes; `only`: of the takes with these indices, all if there are
/// none. Errors of all files are told together.
Result<LabelReading> ReadTruths(const std::vector<episode::Take>& takes,
                                const std::vector<std::string>& given, const std::string& map,
                                const grammar::Program& program,
                                Backward backward = Backward::kRefuse,
                                std::vector<std::size_t> only = {});

/// Takes that nobody has labelled: all events with all roles are compared.
Result<LabelReading> NothingMarked(std::size_t takes, const grammar::Program& program);

/// Times that files of events leave to their take.
struct TakeClock {
  double ticks_per_second = 0;
  std::vector<double> frames_s = {};  ///< the begin of each frame, and the end of the last one
};

/// The same of what somebody found in one of the takes: `given` is a folder with a file for each of
/// them, one table with a column `episode`, or the file of a single take. A take of which they say
/// nothing is an error.
Result<LabelReading> ReadFound(const std::vector<episode::Take>& takes, std::size_t take,
                               const std::string& given, const std::string& map,
                               const grammar::Program& program,
                               const std::function<TakeClock()>& clock);
/// The same of events that have been read.
Result<LabelReading> AsFound(LabelFile file, const std::vector<episode::Take>& takes,
                             const std::string& map, const grammar::Program& program);

/// What is strange, and what a reading left out that ends before it begins: lines, or "".
std::string WarningsOf(const LabelReading& reading);

// Recognised events for annotation programs: comma-separated values, ELAN (EAF 3.0), Praat
// (TextGrid). A label is the event as it is printed, "grasping(right_hand, cup)", which
// ReadLabels() and LabelReading read again. Tested by tests/harness/exchange/labels/labels_test.cc

/// Whether it ends with .csv, .eaf or .TextGrid.
bool CanWriteLabels(const std::string& path);

/// A tier per event and hand; one more where events of a tier would overlap. Times of EAF are
/// whole milliseconds. `end`: of the recording, in ticks; `date`: YYYY-MM-DD, which EAF asks for;
/// `ending`: .csv, .eaf or .TextGrid.
std::string LabelsText(const std::string& ending, const grammar::Timeline& timeline,
                       const truth::HandRoles& hands, grammar::Tick end, const std::string& date);

/// Writes what the grammar of an episode recognises: `only` these events, if there are any. The
/// ending of `file` says how. Returns the count of labels.
tl::expected<std::size_t, episode::NotFound> WriteLabels(episode::Episode& episode,
                                                         const std::vector<std::string>& only,
                                                         const std::string& file,
                                                         const std::string& date);

}  // namespace prehend::exchange

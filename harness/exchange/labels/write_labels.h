// SPDX-License-Identifier: Apache-2.0
// Recognised events for annotation programs: comma-separated values, ELAN (EAF 3.0), Praat
// (TextGrid). A label is the event as it is printed, "grasping(right_hand, cup)", which
// ReadLabels() and LabelReading read again. Tested by tests/harness/exchange/labels/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/episode/find_episodes.h"

namespace prehend::exchange {

/// Whether it ends with .csv, .eaf or .TextGrid.
bool CanWriteLabels(const std::string& path);

/// A tier per event and hand; one more where events of a tier would overlap. Times of EAF are
/// whole milliseconds. `end`: of the recording, in ticks; `date`: YYYY-MM-DD, which EAF asks for;
/// `ending`: .csv, .eaf or .TextGrid.
std::string LabelsText(const std::string& ending, const grammar::Timeline& timeline,
                       grammar::Tick end, const std::string& date);

/// Writes what the grammar of an episode recognises: `only` these events, if there are any. The
/// ending of `file` says how. Returns the count of labels.
tl::expected<std::size_t, episode::NotFound> WriteLabels(episode::Episode& episode,
                                                         const std::vector<std::string>& only,
                                                         const std::string& file,
                                                         const std::string& date);

}  // namespace prehend::exchange

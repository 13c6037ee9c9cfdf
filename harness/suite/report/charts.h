// SPDX-License-Identifier: Apache-2.0
// The charts of the report page: a comparison with its golden, and the signals that decided. Tested
// by tests/harness/suite/report/charts_test.cc
#pragma once

#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/show/replay/replay_data.h"
#include "harness/suite/check/explained.h"
#include "harness/suite/report/history.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_drawings.h"

namespace prehend::suite {

/// One row per event and roles, with the interval of the golden above the recognised one, as an
/// <svg> element. `end` is the episode's end in the comparison's ticks. Without a golden nothing
/// differs.
std::string TimelineSvg(const truth::Comparison& comparison, grammar::Tick end,
                        const truth::EventDrawings& drawings, bool has_golden = true);

/// Who says what happened: people's labels, grammars, programs. None: a golden and a run.
using Sides = std::vector<std::string>;

/// The same of several sides: those after the first are each compared with it. A row has a lane for
/// each, and one for where they differ. Above all are the steps of the script.
std::string TimelineSvg(std::span<const truth::Comparison> comparisons, const Sides& sides,
                        grammar::Tick end, const truth::EventDrawings& drawings, bool has_golden,
                        std::span<const show::PlayedStep> steps);

/// A signal over time: its value, its limit, and when the one crossed the other, as an <svg>
/// element. The signal has at least one sample.
std::string SignalSvg(const DecidingSignal& signal, grammar::Tick ticks_per_second);

/// Adds an explanation for each difference, the first one unfolded, with its signals; and as data
/// what turned at each boundary, which the page's script shows at the cursor.
void AddExplanations(pugi::xml_node section, const Explained& explained,
                     grammar::Tick ticks_per_second);

/// Adds the last runs as data, for the page's script.
void AddHistory(pugi::xml_node body, const std::vector<PastRun>& history);

// Texts of the report page, embedded when the program is built: its style and script
// (harness/suite/report/page), and the script of the 3D replay (harness/suite/report/replay).
// Tested by tests/harness/suite/report/report_test.cc

std::string_view PageStyle();
std::string_view PageScript();

/// The script of the 3D replay, deflated, in base64; empty in a build that could not get it.
std::string_view ReplayBundle();
/// Why there is none; else empty.
std::string_view WhyNoReplay();

/// "grasping(hand=right_hand, object=milk)", as labels are saved.
std::string WithRoles(const grammar::NamedEvent& event);

}  // namespace prehend::suite

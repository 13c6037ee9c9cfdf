// SPDX-License-Identifier: Apache-2.0
// Why events are as they are, and how right they are. A grammar of null is the episode's own.
// Tested by tests/python/test_study.py
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/library/library/episode.h"

namespace prehend {

/// Conditions and signals of a grammar over time.
struct Signals {
  struct Signal {
    std::string name;            ///< "speed_along(milk, table)"
    std::string unit;            ///< SI; "" for plain numbers and for what is 0 or 1
    std::vector<double> values;  ///< one per frame; NaN where it has none
  };
  std::vector<grammar::Tick> ticks;  ///< of the frames
  std::vector<Signal> signals;
};
/// `only`: names of events and conditions, and what signals begin with; empty: all.
PREHEND_API Signals SignalsOf(const Episode& episode, const Grammar* grammar,
                              const std::vector<std::string>& only);

/// What is wrong in a grammar's text and what only looks so; `file`: where it is, or will be.
PREHEND_API grammar::Diagnostics CheckText(const std::string& file, const std::string& text);
/// As `prehend grammar format` lays it out.
PREHEND_API std::string FormatGrammar(const std::string& text);

/// As `prehend explain` prints it.
struct Explanation {
  std::string text, json;
};
/// `event`: "NAME", "NAME@1.2s", "NAME right_hand milk @2s"; of one that did not happen why not;
/// "": all events.
PREHEND_API Explanation Explain(const Episode& episode, const Grammar* grammar,
                                const std::string& event);

/// Labels by people as events of an episode: .csv, .eaf, .TextGrid; `map`: a file, or ""
/// (docs/labels.md). With `entry` those that this one of a file of takes, from 0, has.
PREHEND_API grammar::Timeline ReadLabels(const Episode& episode, const Grammar* grammar,
                                         const std::string& file, const std::string& map,
                                         std::optional<std::size_t> entry = {});

/// Somebody's text, and what is strange in the labels: lines.
using Warned = std::pair<std::string, std::string>;

struct Compared {
  Episode episode;
  grammar::Timeline found;  ///< in any order; line 2 of "found[0]" is the first event
  std::string labels;       ///< a file
  grammar::Tick end = 0;    ///< of what was looked at
};
/// JSON as of `prehend score --truth .. --map .. --json`: "grammars"[0]. Without `collar_s` that of
/// the map, or 50 ms. At least one episode.
PREHEND_API Warned ScoreJson(const Grammar& grammar, const std::vector<Compared>& episodes,
                             const std::string& map, std::optional<double> collar_s);

/// How far parameters may be from their values, against labels, goldens ("golden") or recorded
/// events ("recorded"): CSV as of `prehend grammar margins -o`. `over`: these parameters; empty:
/// all. It works in processes of its own.
PREHEND_API Warned MarginsCsv(const std::vector<std::string>& files, const Grammar& grammar,
                              const std::vector<std::string>& truth, const std::string& map,
                              const std::vector<std::string>& over, double within);

/// A picture of a timeline, SVG: a row per event name and hand, in the grammar's colours.
PREHEND_API std::string TimelineSvg(const grammar::Timeline& timeline, grammar::Tick end,
                                    const Grammar* grammar);

}  // namespace prehend

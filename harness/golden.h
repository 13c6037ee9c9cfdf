// SPDX-License-Identifier: Apache-2.0
// A golden: what must be recognised in a scenario, as text that a person can check against the
// scenario. A run never writes one; `prehend accept` does.
//
//   # scenario: pick_and_place/milk_carton_wrap
//   # grammar: pick_and_place
//   # derived: the reach starts with the hand's motion at 0.5 s; ...
//   # accepted: 2026-01-31 "first golden, checked against the picture"
//   # ticks_per_second: 480
//   #
//   # event       begin_s  end_s   roles
//   supported_by  0.0000   2.0125  object=milk      support=table
//   grasping      1.9021   4.3000  hand=right_hand  object=milk    style=wrap  tolerance=20ms
//   because "..."
//   grasping      5.1000  6.2000  hand=right_hand  object=milk    force~12.5N  accepted=2
//
// NAME~NUMBER is a value of the event, which agrees within 5 % or 0.001; accepted=2 says that this
// line is as the second of the accepted lines made it (otherwise the first);
// oracle=none because "..", or oracle=+29.2/+0.0ms because "..", that the physical oracle sees no
// such event, or other boundaries, and why the line is right nevertheless; oracle=only because
// "..", that only the oracle sees this event: nobody expects it to be recognised. Tested by
// tests/harness/golden_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grammar/timeline.h"
#include "harness/read_result.h"

namespace prehend::harness {

/// What `oracle` of a line says when the event is the oracle's alone, or not the oracle's.
inline constexpr const char* kOnlyOracle = "only";
inline constexpr const char* kNotOfOracle = "none";

struct GoldenEvent {
  grammar::NamedEvent event;          ///< `decided` is not part of a golden: 0
  std::optional<int> tolerance_ms;    ///< instead of the default of two sensing frames
  std::string because;                ///< why this line needs it; never empty beside a tolerance
  std::string oracle;                 ///< how it differs from the physical oracle's; or empty
  std::string oracle_because;         ///< why it is right nevertheless; never empty beside `oracle`
  std::vector<std::string> comments;  ///< lines above it, without "# "
  int accepted = 1;  ///< which acceptance made it so, from 1; one more than there are: the next
  std::string as_written;  ///< the line in the file it was read from; emptied by who changes it
  int line = 0;            ///< of that file, from 1; neither of the two is compared
  bool IsExpected() const { return oracle != kOnlyOracle; }
  friend bool operator==(const GoldenEvent& a, const GoldenEvent& b);
};

/// How much later, in ms, the begin and end of a line with the note "+29.2/-4.2ms" are than the
/// oracle's; nothing of another note.
std::optional<std::pair<double, double>> NoteOffsets_ms(std::string_view note);

struct Acceptance {
  std::string date;  ///< YYYY-MM-DD
  std::string reason;
  friend bool operator==(const Acceptance&, const Acceptance&) = default;
};

struct Golden {
  std::string scenario;  ///< skill/name
  std::string grammar;
  std::vector<std::string> derived;  ///< how it follows from the definitions, one entry per line
  std::vector<Acceptance> accepted;  ///< oldest first
  std::vector<Acceptance> pictures;  ///< when its pictures were accepted, and why
  grammar::Tick ticks_per_second = 480;
  std::vector<std::string> comments;  ///< other lines of the header
  std::vector<GoldenEvent> events;    ///< in the order of ComesBefore()
  std::vector<std::string> closing_comments;
  friend bool operator==(const Golden&, const Golden&) = default;
};

/// `file` is only named in the diagnostics.
ReadResult<Golden> ReadGolden(std::string_view file, std::string_view text);

/// ReadGolden(WriteGolden(x)) == x. Lines that were read stay as they were written; others are
/// canonical.
std::string WriteGolden(const Golden& golden);

/// The events that it expects, alone.
grammar::Timeline ToTimeline(const Golden& golden);

}  // namespace prehend::harness

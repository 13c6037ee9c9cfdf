// SPDX-License-Identifier: Apache-2.0
// A golden: what must be recognised in a scenario, as text that a person can check against the
// scenario. A run never writes one; `prehend accept` does.
//
//   # scenario: pick_and_place/milk_carton_wrap
//   # grammar: pick_and_place
//   # derived: the reach starts with the hand's motion at 0.5 s; ...
//   # accepted: 2026-01-31 "first golden, checked against the picture"
//   # ensemble: 6 plays
//   # ticks_per_second: 480
//   #
//   # event       begin_s  end_s   roles
//   supported_by  0.0000   2.0125  object=milk      support=table
//   grasping      1.9021   4.3000  hand=right_hand  object=milk    style=wrap  tolerance=20ms
//   because "..."
//   grasping      5.1000  6.2000  hand=right_hand  object=milk    force~12.5N  accepted=2
//
// NAME~NUMBER is a value of the event, which agrees within 5 % or 0.001; accepted=2 says that this
// line is as the second of the accepted lines made it (otherwise the first). spread=0.0/12.5ms says
// how far begin and end moved after the metamorphic transforms
// (harness/scenario/transform/transform.h); no spread: not at all. Events that differ after one
// need a line
// "# unsteady: "the reason"". Tested by tests/harness/truth/golden/golden_test.cc
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/base/base/atomic_file.h"
#include "harness/base/base/result.h"

namespace prehend::truth {

/// How far the boundaries of an event moved among the plays of an ensemble, ms.
struct Spread {
  double begin_ms = 0, end_ms = 0;
  friend bool operator==(const Spread&, const Spread&) = default;
};

struct GoldenEvent {
  grammar::NamedEvent event;          ///< `decided` is not part of a golden: 0
  std::optional<int> tolerance_ms;    ///< instead of the default of two sensing frames
  std::string because;                ///< why this line needs it; never empty beside a tolerance
  std::vector<std::string> comments;  ///< lines above it, without "# "
  int accepted = 1;  ///< which acceptance made it so, from 1; one more than there are: the next
  Spread spread;     ///< a measurement: not compared
  std::string as_written;  ///< the line in the file it was read from; emptied when it is changed
  int line = 0;            ///< of that file, from 1; neither of the two is compared
  friend bool operator==(const GoldenEvent& a, const GoldenEvent& b);
};

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
  int ensemble_plays = 0;            ///< of which the spreads are; 0: not measured. Not compared
  std::string unsteady;  ///< why events may differ after a transform; empty: they may not
  grammar::Tick ticks_per_second = 480;
  std::vector<std::string> comments;  ///< other lines of the header
  std::vector<GoldenEvent> events;    ///< in the order of ComesBefore()
  std::vector<std::string> closing_comments;
  friend bool operator==(const Golden& a, const Golden& b);
};

/// `file` is only named in the diagnostics.
Result<Golden> ReadGolden(std::string_view file, std::string_view text);

/// ReadGolden(WriteGolden(x)) == x. Lines that were read stay as they were written; others are
/// canonical.
std::string WriteGolden(const Golden& golden);

/// Its events, alone.
grammar::Timeline ToTimeline(const Golden& golden);

// Where goldens and pending goldens are kept: golden/SKILL/NAME.timeline and
// build/pending/SKILL/NAME.timeline. Tested by tests/harness/truth/golden/golden_files_test.cc

/// A picture in golden/ or in build/pending/: NAME.png is the first of its scenario, NAME-2.png the
/// second.
struct KeptPicture {
  std::string scenario;  ///< skill/name
  int number = 1;
  std::filesystem::path path;
};

/// An error if the golden's header names another scenario; else nothing.
grammar::Diagnostics OfAnotherScenario(std::string_view file, std::string_view text,
                                       const Golden& golden, const std::string& scenario);

/// The place of the name in the line "# scenario: ..".
grammar::Place ScenarioLine(std::string_view text);

/// The golden in this file, if it is there; an error if its header names another scenario.
Result<std::optional<Golden>> ReadGoldenFile(const std::filesystem::path& path,
                                             const std::string& scenario);

/// "" or what went wrong; then the file stays as it was. A golden that would not read back is not
/// written: it would lose every reason that the old one held.
std::string WriteGoldenFile(const std::filesystem::path& path, const Golden& golden);

class GoldenFiles {
 public:
  explicit GoldenFiles(std::filesystem::path project_root) : root_(std::move(project_root)) {}

  /// `scenario` is its id, skill/name, here and below.
  std::filesystem::path GoldenPath(const std::string& scenario) const;
  std::filesystem::path PendingPath(const std::string& scenario) const;

  /// nullopt: there is no golden yet, or nothing is pending.
  Result<std::optional<Golden>> ReadGoldenOf(const std::string& scenario) const;
  Result<std::optional<Golden>> ReadPendingOf(const std::string& scenario) const;

  /// All return "" or what went wrong. Accepting a golden removes what was pending.
  std::string WritePending(const Golden& golden) const;
  std::string WriteGoldenFile(const Golden& golden) const;
  std::string WriteAccepted(const Golden& golden) const;
  void RemovePending(const std::string& scenario) const;

  /// How a planar scenario differs between the engines, as the last `check` found; "" if it does
  /// not. Writing "" removes the file.
  std::filesystem::path EngineDifferencePath(const std::string& scenario) const;
  std::string ReadEngineDifference(const std::string& scenario) const;
  std::string WriteEngineDifference(const std::string& scenario, const std::string& text) const;

  /// Ids of all goldens, and of all that is pending, sorted.
  std::vector<std::string> List() const;
  std::vector<std::string> ListPending() const;

  /// Where the golden of a picture is kept; `file` is its name, as in golden/slide/NAME-2.png.
  std::filesystem::path PicturePath(const std::string& scenario, const std::string& file) const {
    return GoldenPath(scenario).parent_path() / file;
  }
  /// The goldens of a scenario's pictures, by their numbers; and of all scenarios.
  std::vector<KeptPicture> PicturesOf(const std::string& scenario) const;
  std::vector<KeptPicture> Pictures() const;

  /// Where a picture that differs from its golden waits for review, and beside it the picture that
  /// shows the differences.
  std::filesystem::path PendingPicturePath(const std::string& scenario,
                                           const std::string& file) const {
    return PendingPath(scenario).parent_path() / file;
  }
  std::filesystem::path DifferencePath(const std::string& scenario, const std::string& file) const;
  std::vector<KeptPicture> PendingPictures() const;
  void RemovePendingPicture(const std::string& scenario, const std::string& file) const;

 private:
  std::filesystem::path root_;
};

}  // namespace prehend::truth

// SPDX-License-Identifier: Apache-2.0
// What people marked in a recording, as annotation programs write it: tables (comma-separated
// values), a label for each frame, ELAN (EAF), Praat (TextGrid), and our own goldens; the same
// files hold what a recogniser found, and so do lines of JSON. Tested by
// tests/harness/exchange/labels/labels_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/timeline.h"
#include "harness/base/base/result.h"

namespace prehend::exchange {

/// Errors of one file that are told.
inline constexpr std::size_t kMostComplaints = 12;
/// Labels that end before they begin, of which each is told.
inline constexpr std::size_t kMostBackward = 20;

struct Label {
  double begin_s = 0, end_s = 0;  ///< no numbers: its event is compared, and is not there
  std::string text, tier;         ///< "" where the file has no tiers
  grammar::Place place;
  std::vector<grammar::Role> roles;      ///< of a table: what the columns of roles hold
  std::vector<std::string> keys;         ///< of a table: what the columns CsvReading::keys hold
  std::optional<double> decided_s = {};  ///< of what was found, if the file says when

  bool IsMoment() const { return begin_s == end_s; }
};

/// What a map says of the columns of a table. "": found by their usual names.
struct CsvReading {
  std::string begin, end, duration, label, tier;
  std::string time, kind;            ///< of tables with a row for START and one for STOP
  std::string frame;                 ///< of tables with a row for each frame
  std::string take;                  ///< whose take a row is of; "ignore": no column says that
  std::vector<grammar::Role> roles;  ///< a role, and the name of its column
  std::set<std::string> role_names;  ///< of the others: columns called so hold them
  std::vector<std::string> keys;     ///< names of columns that rows are told apart by
  double unit_s = 0;   ///< of the times; 0: as the names of the columns say, otherwise seconds
  double rate_hz = 0;  ///< of the video, for times in frames; 0: not known
  bool in_frames = false;
  /// Of the recording that labels are of, if it is known: times in its ticks, and lines for each of
  /// its frames.
  double ticks_per_second = 0;
  std::vector<double> frames_s = {};  ///< the begin of each frame, and the end of the last one
};

struct LabelFile {
  std::string file;
  std::string text;                  ///< of the file as UTF-8, for messages
  std::vector<Label> labels;         ///< without empty ones, in the order of the file
  std::size_t backward = 0;          ///< labels that end before they begin, which were left out
  std::vector<Label> empty;          ///< those without text, which were left out
  bool has_header = true;            ///< without labels, it says that nothing happened
  double frames_s = 0, rate_hz = 0;  ///< of lines for all frames: how long they last, their rate
  /// Of a table: keys of rows with neither times nor a label, which say that of a take.
  std::set<std::vector<std::string>> nothing_in;
  grammar::Diagnostics warnings;
  /// Of a table: columns that seem to say whose take a row is of, and hold several values.
  std::vector<std::string> several;
  std::set<std::string> roles;      ///< of a table: those that have a column
  std::vector<std::string> unread;  ///< of a table: columns that mean nothing

  grammar::Diagnostic At(grammar::Place place, std::string message, std::string hint = {}) const;
};

/// ".csv", ".tsv", ".eaf", ".TextGrid", ".timeline", ".txt": a file of labels by its ending.
bool IsLabelFile(const std::string& path);
/// The endings above.
const std::vector<std::string>& LabelEndings();

/// What is done with labels that end before they begin.
enum class Backward { kRefuse, kSkip };

bool IsTable(const std::string& path);

/// The words of the first line of a table; none if it cannot be read.
std::vector<std::string> HeadOfTable(const std::string& path);

/// Errors have file, line and column; at most a dozen, and twenty labels that end before they
/// begin. Also reads .jsonl, which by its ending alone may be a recording.
Result<LabelFile> ReadLabels(const std::string& path, const CsvReading& csv = {},
                             Backward backward = Backward::kRefuse);

// The readers of one format each; `text` is that of the file. They fill `file.labels`.
/// Times are numbers, 1:02:03.5 and 02:03.5, or 2026-10-25T01:59:57.010, which is seconds of 1970.
grammar::Diagnostics ReadCsvLabels(LabelFile& file, const CsvReading& how = {});
/// Without a header begin, end and label, with tabs between them (Audacity).
bool IsLabelTrack(std::string_view text);
/// A line for each frame, with nothing but its label (MS-TCN).
/// Lines that are as many as the recording has frames are those of these; else `rate_hz` counts.
grammar::Diagnostics ReadFrameLabels(LabelFile& file, const CsvReading& how);
grammar::Diagnostics ReadJsonLabels(LabelFile& file, double ticks_per_second);
/// What is wrong with a line that has an event, or "".
std::string ReadEventLine(const nlohmann::json& line, double ticks_per_second, Label& label);
/// EAF 2.7 to 3.0 (Max Planck Institute for Psycholinguistics): time slots in milliseconds,
/// annotations that are aligned or refer to an aligned one. Slots without a time are spaced evenly
/// between their neighbours, as ELAN shows them.
grammar::Diagnostics ReadEafLabels(LabelFile& file);
/// TextGrid, long and short: free-standing numbers, texts and flags (the Praat manual, "TextGrid
/// file formats"). Labels of point tiers begin and end at their time.
grammar::Diagnostics ReadTextGridLabels(LabelFile& file);
grammar::Diagnostics ReadGoldenLabels(LabelFile& file);

}  // namespace prehend::exchange

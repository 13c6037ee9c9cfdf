// SPDX-License-Identifier: Apache-2.0
// The suite as one web page, one file that works offline: causes of failures, verdicts with what
// failed first, timelines (golden above recognised), pictures, differences, and the commands that
// show them again. Tested by tests/harness/suite/report/report_test.cc
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/suite/check/verdict.h"
#include "harness/suite/report/charts.h"
#include "harness/suite/report/history.h"

namespace prehend::suite {

struct ReportTable {
  std::string title;
  std::vector<std::vector<std::string>> rows;  ///< the first is its head
};

struct ReportHeader {
  std::string command;      ///< that made the page
  std::string date;         ///< YYYY-MM-DD
  std::string commit = {};  ///< of the project: "1a2b3c4d5e, with changes"; "": it is not known
  std::string machine = {};
  std::string folder = {};  ///< what the files of pictures are relative to
  std::string title = "Regression suite";
  std::vector<PastRun> history = {};  ///< of the same scenarios, with this run
  /// Not empty: not runs and goldens are compared, but what these say of the same takes. Verdicts
  /// have a comparison of the second with the first, and in `labelled` those of the further ones.
  Sides sides = {};
  std::vector<ReportTable> tables = {};
  std::string scores = {};  ///< as text
};

/// With the commit that `root` is at, and this machine.
ReportHeader HeaderOf(const std::string& command, const std::string& root, const std::string& date);

/// Pictures are in the page, those of failures first, up to this size (as text) in all; of the
/// others the page says that they lie beside it.
inline constexpr std::size_t kMostPictureBytes = 15'000'000;

/// The same for 3D replays.
inline constexpr std::size_t kMostReplayBytes = 10'000'000;

std::string ReportHtml(const std::vector<ScenarioVerdict>& verdicts, const ReportHeader& header);

/// Differences and pending goldens are failures, what could not be read or did not end is an error,
/// what nothing changed for is skipped. The class of a case is its skill.
std::string JunitXml(const std::vector<ScenarioVerdict>& verdicts);

}  // namespace prehend::suite

// SPDX-License-Identifier: Apache-2.0
// What people marked in a recording, as annotation programs write it: comma-separated values, ELAN
// (EAF), Praat (TextGrid), and our own goldens. Tested by tests/harness/labels/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "harness/base/result.h"

namespace prehend::harness::labels {

/// Errors of one file that are told.
inline constexpr std::size_t kMostComplaints = 12;

struct Label {
  double begin_s = 0, end_s = 0;
  std::string text, tier;  ///< "" where the file has no tiers
  grammar::Place place;
};

struct LabelFile {
  std::string file;
  std::string text;           ///< of the file as UTF-8, for messages
  std::vector<Label> labels;  ///< without empty ones, in the order of the file

  grammar::Diagnostic At(grammar::Place place, std::string message, std::string hint = {}) const;
};

/// ".csv", ".eaf", ".TextGrid", ".timeline": a file of labels by its ending.
bool IsLabelFile(const std::string& path);
/// The endings above.
const std::vector<std::string>& LabelEndings();

/// Errors have file, line and column; at most a dozen.
Result<LabelFile> ReadLabels(const std::string& path);

// The readers of one format each; `text` is that of the file. They fill `file.labels`.
grammar::Diagnostics ReadCsvLabels(LabelFile& file);
/// EAF 2.7 to 3.0 (Max Planck Institute for Psycholinguistics): time slots in milliseconds,
/// annotations that are aligned or refer to an aligned one. Slots without a time are spaced evenly
/// between their neighbours, as ELAN shows them.
grammar::Diagnostics ReadEafLabels(LabelFile& file);
/// TextGrid, long and short: free-standing numbers, texts and flags (the Praat manual, "TextGrid
/// file formats"). Labels of point tiers begin and end at their time.
grammar::Diagnostics ReadTextGridLabels(LabelFile& file);
grammar::Diagnostics ReadGoldenLabels(LabelFile& file);

}  // namespace prehend::harness::labels

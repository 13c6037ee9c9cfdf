// SPDX-License-Identifier: Apache-2.0
// Grammars against what people marked in recordings. Tested by tests/program/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/exchange/labels/read_truths.h"
#include "harness/measure/score/score.h"

namespace prehend::measure {

struct LabelsRequest {
  std::string root;
  std::vector<episode::EpisodeName> episodes;
  std::vector<std::string> grammars;     ///< names or paths; empty: the one that the episodes name
  std::vector<std::string> settings;     ///< "name=value", of parameters of all grammars
  std::vector<std::string> label_files;  ///< one per episode, or one folder
  std::string label_map;                 ///< "": labels are events
  exchange::Backward backward = exchange::Backward::kRefuse;
  double collar_s = 0.05;
};

struct LabelScores {
  std::vector<Score> of_grammars;
  std::vector<Score> by_hand;            ///< each hand for itself, in the same order
  std::vector<std::string> differences;  ///< from the labels, in the same order; lines or ""

  bool HasHands() const;
};

/// `warnings`: of labels and episodes, also if there is no result.
Result<LabelScores> ScoreLabels(const LabelsRequest& request, std::string& warnings);

/// Tables for people; with `differences` these, too.
std::string LabelScoresText(const LabelScores& scores, double collar_s, bool differences);

}  // namespace prehend::measure

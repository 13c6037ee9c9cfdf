// SPDX-License-Identifier: Apache-2.0
// Grammars and others against what people marked in recordings. Tested by
// tests/program/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/exchange/labels/read_truths.h"
#include "harness/measure/score/score.h"

namespace prehend::measure {

struct LabelsRequest {
  std::string root;
  std::vector<episode::Take> takes;
  Asking asking;                         ///< without sources the grammars of the episodes
  std::vector<std::string> settings;     ///< "name=value", of parameters of all grammars
  std::vector<std::string> label_files;  ///< one per take, one of all, or one folder
  exchange::Backward backward = exchange::Backward::kRefuse;
  double collar_s = 0.05;
  bool is_collar_asked = false;  ///< instead of those of the map
  bool first_is_truth = false;   ///< there are no labels: the others are compared with the first
};

/// What one source says of all takes.
struct Opinion {
  std::string name;
  std::vector<EpisodeToScore> takes;
};

struct LabelScores {
  std::vector<Score> of_grammars;        ///< of several sets of takes one for each
  std::vector<Score> by_hand;            ///< each hand for itself, in the same order
  std::vector<std::string> differences;  ///< from the labels, in the same order; lines or ""
  exchange::Counted counted;
  bool of_people = false;         ///< what was found is labels, too
  std::string failures;           ///< of programs: lines, or ""
  std::string first;              ///< LabelsRequest::first_is_truth: its name
  std::vector<Opinion> opinions;  ///< of each source that is no file of labels
  Collars collars_s;              ///< of kinds of events, that scores are made with

  bool HasHands() const;
};

/// `warnings`: of labels and episodes, also if there is no result.
Result<LabelScores> ScoreLabels(const LabelsRequest& request, std::string& warnings);

/// Files of labels against others, without a recording.
struct LabelFilesRequest {
  std::string root;
  std::vector<std::string> files, truth;  ///< in the same order
  std::string grammar;                    ///< name or path; "": labels mean themselves
  std::string label_map;
  exchange::Backward backward = exchange::Backward::kRefuse;
  double collar_s = 0.05;
  bool is_collar_asked = false;
};
Result<LabelScores> ScoreLabelFiles(const LabelFilesRequest& request, std::string& warnings);

/// Adds of what was found in one take what the labels can judge.
void AddFound(const grammar::Timeline& found, std::size_t take,
              const exchange::LabelReading& truths, double collar_s, EpisodeToScore& labelled);

/// Whether lines for frames end long before their take, or long after it: then the rate of the map
/// may be wrong.
std::string RateWarning(const exchange::LabelReading& truths, std::size_t take, double take_s);
/// Where labels are found if they are moved: lines, or "".
std::string ClockWarning(const std::string& grammar, const std::vector<EpisodeToScore>& episodes,
                         const exchange::LabelReading& truths);

/// Adds the scores of one grammar, for all and for each hand.
void AddScores(const std::string& grammar, std::vector<EpisodeToScore> episodes, double collar_s,
               const Collars& collars, LabelScores& scores);

/// Tables for people; with `differences` these, too.
std::string LabelScoresText(const LabelScores& scores, bool differences);

}  // namespace prehend::measure

// SPDX-License-Identifier: Apache-2.0
// The pictures of a run against the goldens of pictures.
// Tested by tests/harness/suite/judge/judge_pictures_test.cc
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/show/pictures/pictures.h"
#include "harness/suite/judge/judge.h"

namespace prehend::suite {

/// A drawn picture that has a golden.
struct PictureComparison {
  std::filesystem::path golden, drawn;
  std::vector<std::string> told;   ///< what tells it from its golden; empty: nothing
  std::filesystem::path shown_in;  ///< where StorePictures() shows what differs; or empty
};

/// The goldens of a scenario's pictures, those that exist.
show::GoldenOf GoldensOf(const std::string& id, const std::string& root);

/// Drawn pictures without a golden are left out. `root` is the project's. With `shown` what differs
/// is to be shown in a picture of its own.
std::vector<PictureComparison> ComparisonsOf(const std::string& id,
                                             const std::vector<show::WrittenPicture>& drawn,
                                             const std::string& root, bool shown);

/// Several lines, or empty. `accept` is the command that accepts the pictures, or empty.
std::string PictureDifferencesText(const std::vector<PictureComparison>& compared,
                                   const std::string& accept);

/// Golden pictures beyond the `requested` ones of the scenario.
Findings JudgeUnrequestedPictures(const std::string& id, std::size_t requested,
                                  const std::string& root, const std::string& accept);

/// Keeps pictures that differ for `prehend review`, and removes those that do not any more.
void StorePictures(const std::string& id, const std::vector<PictureComparison>& compared,
                   const std::string& root);

}  // namespace prehend::suite

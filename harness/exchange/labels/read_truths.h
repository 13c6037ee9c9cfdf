// SPDX-License-Identifier: Apache-2.0
// From the options of a command to the labels of its recordings. Tested by
// tests/program/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/episode/run/episode_name.h"
#include "harness/exchange/labels/label_map.h"

namespace prehend::exchange {

/// `given`: files of labels or a folder; `map`: a file, or "" for none. What is read has one file
/// per episode. Errors of all files are told together.
Result<LabelReading> ReadTruths(const std::vector<episode::EpisodeName>& episodes,
                                const std::vector<std::string>& given, const std::string& map,
                                const grammar::Program& program,
                                Backward backward = Backward::kRefuse);

/// What a reading left out, as a line of warning; "" if it left out nothing.
std::string BackwardWarning(const LabelReading& reading);

}  // namespace prehend::exchange

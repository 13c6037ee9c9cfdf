// SPDX-License-Identifier: Apache-2.0
// From the options of a command to the labels of its recordings. Tested by
// tests/program/labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/labels/label_map.h"
#include "harness/labels/take.h"

namespace prehend::harness::labels {

/// `given`: files of labels or a folder; `map`: a file, or "" for none. What is read has one file
/// per take.
Result<LabelReading> ReadTruths(const std::vector<TakeName>& takes,
                                const std::vector<std::string>& given, const std::string& map,
                                const grammar::Program& program);

}  // namespace prehend::harness::labels

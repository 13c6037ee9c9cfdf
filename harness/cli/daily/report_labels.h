// SPDX-License-Identifier: Apache-2.0
// From takes and what people, grammars and programs say of them to a page. Tested by
// tests/program/report_labels_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/measure/score/score_labels.h"
#include "harness/suite/report/report.h"

namespace prehend::cli {

/// Makes the verdicts, one for each take, those of a comparison with the first side ("labels"), and
/// sorts them, the worst first. The header has sides, tables and title. `page`: where it will lie.
/// `warnings`: of videos that are not there.
suite::ReportHeader CompareSides(const measure::LabelScores& scores, const std::string& first,
                                 double collar_s, const std::string& page,
                                 std::vector<suite::ScenarioVerdict>& verdicts,
                                 std::string& warnings);

}  // namespace prehend::cli

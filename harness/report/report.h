// SPDX-License-Identifier: Apache-2.0
// The suite as one web page: verdicts, timelines (golden above recognised), pictures, differences,
// and the commands that show them again. One file, no scripts; pictures beside it. Tested by
// tests/harness/report/report_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/check/verdict.h"

namespace prehend::harness {

std::string ReportHtml(const std::vector<ScenarioVerdict>& verdicts);

}  // namespace prehend::harness

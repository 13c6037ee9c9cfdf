// SPDX-License-Identifier: Apache-2.0
// Texts of the report page, embedded when the program is built: its style and script
// (harness/suite/report/page), and the script of the 3D replay (harness/suite/report/replay).
// Tested by tests/harness/suite/report/report_test.cc
#pragma once

#include <string_view>

namespace prehend::suite {

std::string_view PageStyle();
std::string_view PageScript();

/// The script of the 3D replay, deflated, in base64; empty in a build that could not get it.
std::string_view ReplayBundle();
/// Why there is none; else empty.
std::string_view WhyNoReplay();

}  // namespace prehend::suite

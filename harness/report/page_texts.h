// SPDX-License-Identifier: Apache-2.0
// Texts of the report page, embedded when the program is built: its style and script
// (harness/report/page), and the script of the 3D replay (harness/report/replay). Tested by
// tests/harness/report/report_test.cc
#pragma once

#include <string_view>

namespace prehend::harness {

std::string_view PageStyle();
std::string_view PageScript();

/// The script of the 3D replay, deflated, in base64; empty in a build that could not get it.
std::string_view ReplayBundle();
/// Why there is none; else empty.
std::string_view WhyNoReplay();

}  // namespace prehend::harness

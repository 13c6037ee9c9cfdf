// SPDX-License-Identifier: Apache-2.0
// The usual frame of a recording, read straight from its text: nothing but numbers, plain names and
// known keys, as `import` and trackers write them. It gives what the field tables of
// harness/episode/sense/episode_format.h give, some twenty times faster, and leaves everything else
// to them: every mistake, and what is rare. Tested by
// tests/harness/episode/sense/scan_frame_test.cc
#pragma once

#include <string_view>

#include "harness/episode/sense/episode_format.h"

namespace prehend::episode {

/// False if the line is anything else than a frame without touches, or has a mistake, a value out
/// of its bounds or a key twice; then `frame` means nothing. Places are not filled in. Memory of
/// `frame` is used again.
bool ScanFrame(std::string_view line, FrameEntry& frame);

}  // namespace prehend::episode

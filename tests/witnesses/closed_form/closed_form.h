// SPDX-License-Identifier: Apache-2.0
// Recordings without physics, whose events are known on paper (tests/witnesses/README.md). They
// judge grammar and oracle alike, and know neither. Tested by
// tests/witnesses/closed_form/read_closed_form_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/base/result.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/snapshot.h"

namespace prehend::witnesses {

/// An event as derived from docs/events.md.
struct KnownEvent {
  std::string label;  ///< "reaching(hand, cup)"
  double begin_s = 0, end_s = 0;
};

/// A story in one sampling.
struct ClosedFormRecording {
  std::string sampling;         ///< "240 Hz", or "120 Hz, frames lost"
  scenario::Scenario scenario;  ///< the scene, without a script
  std::vector<physics::Snapshot> frames;
  grammar::Tick end = 0;  ///< the first tick after the episode
};

struct ClosedForm {
  std::string name, file, shows;
  std::vector<KnownEvent> truth;                ///< every event, in the order of the file
  std::vector<ClosedFormRecording> recordings;  ///< one per sampling
};

/// Reads a file and computes its recordings.
Result<ClosedForm> ReadClosedForm(const std::string& path);
/// The same from a text.
Result<ClosedForm> ReadClosedFormText(const std::string& path, std::string text);

/// The files of a folder, sorted.
std::vector<std::string> ClosedFormFiles(const std::string& folder);

}  // namespace prehend::witnesses

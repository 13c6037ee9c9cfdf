// SPDX-License-Identifier: Apache-2.0
// The hands of physics/library, for tests: the hand that is tested is the one that is shipped.
#pragma once

#include <stdexcept>
#include <string>

#include "harness/scenario/read/read_scenario.h"

namespace prehend::physics {

inline HandModel LibraryHand(const std::string& name) {
  auto read = scenario::ReadHandModel(PREHEND_SOURCE_DIR "/physics/library/" + name + ".hand.yaml");
  if (!read) throw std::runtime_error("hand file " + name + ": " + ErrorsOf(read).front().message);
  return std::move(*read);
}

}  // namespace prehend::physics

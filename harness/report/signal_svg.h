// SPDX-License-Identifier: Apache-2.0
// A signal that decided over time: its value, its limit, and where the one crossed the other.
// Tested by tests/harness/report/signal_svg_test.cc
#pragma once

#include <string>

#include "harness/check/explained.h"

namespace prehend::harness {

/// An <svg> element. The signal has at least one sample.
std::string SignalSvg(const DecidingSignal& signal, grammar::Tick ticks_per_second);

}  // namespace prehend::harness

// SPDX-License-Identifier: Apache-2.0
// How a timeline follows from the definitions: what the physical oracle says about the same run.
// Goes into the provenance of a golden. Tested by tests/harness/derivation_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/run_scenario.h"

namespace prehend::harness {

/// Lines that begin so are written by the program and renewed with every acceptance; others are
/// people's.
inline constexpr const char* kOracleLine = "oracle: ";

/// An event that the run and the oracle see otherwise: a recognised one, or one that is the
/// oracle's alone.
struct OracleNote {
  grammar::NamedEvent event;
  std::string text;  ///< GoldenEvent::oracle
};

struct Derivation {
  bool agrees = false;  ///< no event missing or extra, every boundary within two sensing frames
  std::vector<std::string> lines;  ///< each begins with kOracleLine
  std::vector<OracleNote> notes;   ///< of every event that differs
  grammar::Tick tolerance = 0;     ///< those two frames
};

/// What the definitions and a grammar both speak of.
struct Judged {
  grammar::Timeline truth, found;
};
/// The run must have been recorded.
Judged JudgedByOracle(const Scenario& scenario, const grammar::Program& program,
                      const RunResult& run);

/// The run must have been recorded. Events that the oracle has no definition for are not judged,
/// and counted.
Derivation Derive(const Scenario& scenario, const grammar::Program& program, const RunResult& run);

/// People's lines, then the oracle's.
std::vector<std::string> RenewedDerivation(const std::vector<std::string>& lines,
                                           const Derivation& derivation);

}  // namespace prehend::harness

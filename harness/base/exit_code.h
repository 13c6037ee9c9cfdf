// SPDX-License-Identifier: Apache-2.0
// How the program ends: part of the command line's contract, scripts rely on it.
#pragma once

namespace prehend::harness {

enum class ExitCode {
  kAgrees = 0,
  kDiffers = 1,   ///< a golden, or an invariant
  kBadInput = 2,  ///< a file or the command line
  kFailure = 3,   ///< the simulation, or the program itself
  kNothing = 4,   ///< nothing was selected or found
  kPending = 5,   ///< goldens wait for acceptance
};

}  // namespace prehend::harness

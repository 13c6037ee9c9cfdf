// SPDX-License-Identifier: Apache-2.0
// Memory that the system refuses, noticed where it is refused. What a library does that did not get
// its memory (a null pointer, an abort, an exception through code that expects none) cannot be told
// from a crash afterwards. Tested by tests/harness/worker_pool_test.cc
#pragma once

namespace prehend::harness {

/// How a process ends that was refused memory.
inline constexpr int kMemoryWasRefused = 71;

/// From now on this process ends with kMemoryWasRefused, at once and without a word, when it is
/// refused memory: in C++ and in C alike. For processes that have nothing to lose.
void ExitWhenMemoryIsRefused();

}  // namespace prehend::harness

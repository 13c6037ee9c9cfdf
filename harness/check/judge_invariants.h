// SPDX-License-Identifier: Apache-2.0
// A run against what must hold of every timeline. Tested by
// tests/harness/check/judge_invariants_test.cc
#pragma once

#include "harness/check/judge.h"

namespace prehend::harness {

Findings JudgeInvariants(const CheckedRun& checked);

}  // namespace prehend::harness

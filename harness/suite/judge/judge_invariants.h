// SPDX-License-Identifier: Apache-2.0
// A run against what must hold of every timeline, and the laws of its grammar. Tested by
// tests/harness/suite/judge/judge_invariants_test.cc
#pragma once

#include "harness/suite/judge/judge.h"

namespace prehend::suite {

Findings JudgeInvariants(const CheckedRun& checked);

Findings JudgeLaws(const CheckedRun& checked);

}  // namespace prehend::suite

// SPDX-License-Identifier: Apache-2.0
// What ends a step before its time: "touching(milk)" or "gap(milk) < 5 mm", either with
// ", or go on". Tested by tests/harness/scenario/format/scenario_errors_test.cc
#pragma once

#include "harness/base/yaml/value_format.h"
#include "physics/motion/script.h"

namespace prehend::scenario {

ValueFormat<physics::Until> UntilFormat();

}  // namespace prehend::scenario

// SPDX-License-Identifier: Apache-2.0
// See harness/base/base/build_text.h. harness/CMakeLists.txt knows the compiler.
#include "harness/base/base/build_text.h"

namespace prehend {

std::string BuildText() { return PREHEND_BUILD; }

}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// The compiler and its flags come from harness/CMakeLists.txt.
#include "harness/base/base/build_text.h"

namespace prehend {

std::string BuildText() { return PREHEND_BUILD; }

}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// Bytes as text, for web pages. Tested by tests/harness/base/base/base64_test.cc
#pragma once

#include <string>
#include <string_view>

namespace prehend {

/// RFC 4648, with padding.
std::string Base64(std::string_view bytes);

}  // namespace prehend

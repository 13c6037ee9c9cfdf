// SPDX-License-Identifier: Apache-2.0
// What recorders compress. "" if it does not become `size` bytes. Tested by
// tests/program/import_mcap_test.cc
#pragma once

#include <string>
#include <string_view>

namespace prehend::exchange {

/// Frames of LZ4, one after another.
std::string FromLz4(std::string_view packed, std::size_t size);
std::string FromZstd(std::string_view packed, std::size_t size);

}  // namespace prehend::exchange

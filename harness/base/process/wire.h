// SPDX-License-Identifier: Apache-2.0
// Values on their way from a worker to its parent. A type that goes this way has a to_json and a
// from_json with all its fields. Tested by tests/harness/base/process/wire_test.cc
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace prehend {

/// As CBOR, since JSON has no infinite numbers and refuses bytes that are no UTF-8.
template <typename T>
std::string ToWire(const T& value) {
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(nlohmann::json(value));
  return {bytes.begin(), bytes.end()};
}

/// Throws nlohmann::json::exception if the bytes are not from ToWire() of that type.
template <typename T>
T FromWire(const std::string& bytes) {
  return nlohmann::json::from_cbor(bytes).get<T>();
}

}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
// The messages of an MCAP file, in the order in which they stand there. Read from front to back,
// without the index. Format: https://mcap.dev/spec, version 0. Tested by
// tests/program/import_mcap_test.cc
#pragma once

#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {

/// `size`: of the whole stream, bytes. Returns what is wrong with the file, with the byte at which
/// it was seen, or "". `channels` hears of each channel, also of those without a message.
std::string ReadMcap(std::istream& in, std::uint64_t size, const TakesMessage& take,
                     const HearsOfChannel& channels);

}  // namespace prehend::exchange

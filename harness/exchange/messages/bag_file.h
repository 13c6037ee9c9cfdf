// SPDX-License-Identifier: Apache-2.0
// The messages of a bag of ROS 1, in the order in which they stand there. Read from front to back,
// without the index. Format: http://wiki.ros.org/Bags/Format/2.0. Tested by
// tests/program/import_bag_test.cc
#pragma once

#include "harness/exchange/messages/log_file.h"

namespace prehend::exchange {

/// As ReadMcap() (harness/exchange/messages/mcap_file.h), with its limits. A connection is a
/// channel whose messages are encoded as "ros1".
std::string ReadBag(std::istream& in, std::uint64_t size, const TakesMessage& take,
                    const HearsOfChannel& channels);

}  // namespace prehend::exchange

// SPDX-License-Identifier: Apache-2.0
// What a worker sends arrives as it was.
#include <gtest/gtest.h>

#include <limits>

#include "harness/base/process/worker_pool.h"
#include "harness/truth/timeline/timeline_wire.h"

namespace prehend {
namespace {

TEST(Wire, ATimelineArrivesWithAllItsFields) {
  const grammar::Timeline sent{
      .ticks_per_second = 480,
      .events = {{.event = "hitting",
                  .roles = {{"hand", "right_hand"}, {"style", "hard"}},
                  .interval = {3, 5},
                  .decided = 7,
                  .open_end = true,
                  .values = {{"force", std::numeric_limits<double>::infinity(), "N"}}}}};
  const auto got = FromWire<grammar::Timeline>(ToWire(sent));
  EXPECT_EQ(got.ticks_per_second, 480);
  ASSERT_EQ(got.events.size(), 1u);
  EXPECT_EQ(got.events[0].event, "hitting");
  EXPECT_EQ(got.events[0].roles, sent.events[0].roles);
  EXPECT_EQ(got.events[0].interval, sent.events[0].interval);
  EXPECT_EQ(got.events[0].decided, 7);
  EXPECT_TRUE(got.events[0].open_end);
  EXPECT_EQ(got.events[0].values, sent.events[0].values);
}

TEST(Wire, BytesThatAreNoUtf8AreSent) {
  EXPECT_EQ(FromWire<std::string>(ToWire(std::string("\xff\xfe"))), "\xff\xfe");
}

TEST(Wire, AnotherTypeIsAnError) {
  EXPECT_THROW(FromWire<grammar::Timeline>(ToWire(std::string("x"))), nlohmann::json::exception);
  EXPECT_THROW(FromWire<std::string>("?"), nlohmann::json::exception);
}

}  // namespace
}  // namespace prehend

// SPDX-License-Identifier: Apache-2.0
#include "drivers/gpio/csv_source.hpp"

#include <gtest/gtest.h>

#include "hal/files/file.hpp"

namespace cairn::gpio {
namespace {

using namespace std::chrono_literals;

TEST(CsvSource, ReplaysEdgesAndNamesDamagedLines) {
  const auto path = std::filesystem::path(testing::TempDir()) / "cairn_gpio.csv";
  ASSERT_TRUE(write_file_atomic(path, std::string_view("stamp_ns,line,level\n100,estop,1\n150,door,1\n"
                                                       "200,pps,1\n300,estop,7\n400,estop,0")));
  auto source = CsvSource::open(path, SourceId{3}).value();
  Packet packet;
  const auto event = [&](Duration arrival, LineEvent expected) {
    ASSERT_EQ(source->next(packet, 0ms).value(), Poll::kPacket);
    EXPECT_EQ(packet.arrival, Time{arrival});
    EXPECT_EQ(packet.source, SourceId{3});
    EXPECT_EQ(decode_event(packet).value(), expected);
  };
  event(100ns, {Line::kEStop, true, false, 0});
  event(200ns, {Line::kPps, true, false, 0});
  const auto damaged = source->next(packet, 0ms);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().where, path.string() + ":5");
  event(400ns, {Line::kEStop, false, false, 0});
  EXPECT_EQ(source->next(packet, 0ms).value(), Poll::kEnd);
  EXPECT_EQ(source->counters().unknown, 1U);
  std::filesystem::remove(path);
  EXPECT_EQ(CsvSource::open(path, {}).error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace cairn::gpio

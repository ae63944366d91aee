// SPDX-License-Identifier: Apache-2.0
#include "drivers/drive/can/candump_source.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "hal/files/file.hpp"
#include "tests/drivers/drive/files.hpp"

namespace cairn::drive {
namespace {

using namespace std::chrono_literals;

class CandumpSourceTest : public testing::Test {
 protected:
  void open(std::string_view text, const CandumpSource::Options& options = {}) {
    const auto path = std::filesystem::path(testing::TempDir()) /
                      (std::string("cairn_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".log");
    ASSERT_TRUE(write_file_atomic(path, text));
    source = CandumpSource::open(path, options).value();
    std::filesystem::remove(path);
  }
  std::vector<Duration> arrivals() {
    std::vector<Duration> found;
    while (source->next(packet, 0ms).value() == Poll::kPacket) found.push_back(packet.arrival.time_since_epoch());
    return found;
  }
  std::unique_ptr<CandumpSource> source;
  Packet packet;
};

TEST_F(CandumpSourceTest, DeliversFramesInOrder) {
  open("# comment\n(10.000001) can0 123#11\n(10.000002) can1 124#22 T\n\n(10.000003) can0 125#33\n",
       {SourceId{4}, "can0", {}});
  ASSERT_EQ(source->next(packet, 0ms).value(), Poll::kPacket);
  EXPECT_EQ(packet.source, SourceId{4});
  EXPECT_EQ(packet.arrival, Time{10s + 1us});
  EXPECT_EQ(decode_frame(packet.payload()).value(), make_frame(0x123, {0x11}));
  ASSERT_EQ(source->next(packet, 0ms).value(), Poll::kPacket);
  EXPECT_EQ(packet.sequence, 1U);
  EXPECT_EQ(source->next(packet, 0ms).value(), Poll::kEnd);
  EXPECT_EQ(source->next(packet, 0ms).value(), Poll::kEnd);
  EXPECT_EQ(source->counters().filtered, 1U);
}

TEST_F(CandumpSourceTest, FindsOutWhatTheStampsMean) {
  open("(000.000000) can0 123 [0]\n(000.000100) can0 123 [0]\n(000.000050) can0 123 [0]\n");
  EXPECT_EQ(arrivals(), (std::vector<Duration>{0us, 100us, 150us})) << "-td";
  open("(000.000000) can0 123 [0]\n(000.000100) can0 123 [0]\n(000.000150) can0 123 [0]\n");
  EXPECT_EQ(arrivals(), (std::vector<Duration>{0us, 100us, 150us})) << "-tz";
  open("can0 123 [0]\ncan0 123 [0]\n");
  EXPECT_EQ(arrivals(), (std::vector<Duration>{1ms, 2ms})) << "without";
  open("(1699999999.5) can0 123#\n(1699999998.5) can0 123#\n");
  EXPECT_EQ(arrivals(), (std::vector<Duration>{1699999999500ms, 1699999998500ms}))
      << "a step of the clock is no distance";
}

TEST_F(CandumpSourceTest, NamesTheLineAndGoesOn) {
  open("(1.0) can0 123#11\n(1.0) can0 12#11\n" + std::string(2000, 'x') + "\n(1.1) can0 123#22");
  ASSERT_EQ(source->next(packet, 0ms).value(), Poll::kPacket);
  const auto second = source->next(packet, 0ms), third = source->next(packet, 0ms);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().where.find(":2"), std::string::npos);
  EXPECT_FALSE(second.error().cause.empty());
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().code, Errc::kLimit);
  ASSERT_EQ(source->next(packet, 0ms).value(), Poll::kPacket);
  EXPECT_EQ(decode_frame(packet.payload())->data[0], 0x22);
}

TEST_F(CandumpSourceTest, AMissingFileIsNotFound) {
  EXPECT_EQ(CandumpSource::open("no/such/drive.log", {}).error().code, Errc::kNotFound);
}

TEST_F(CandumpSourceTest, ReplaysTheSample) {
  const auto path = test::can_data("sample.candump.log");
  SKIP_WITHOUT(path);
  source = CandumpSource::open(path, {}).value();
  EXPECT_EQ(arrivals().size(), 6158U);
  EXPECT_EQ(source->counters().malformed, 0U);
}

}  // namespace
}  // namespace cairn::drive

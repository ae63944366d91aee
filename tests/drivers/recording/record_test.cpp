// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/record.hpp"

#include <gmock/gmock.h>

#include "drivers/recording/recording_reader.hpp"
#include "tests/drivers/recording/files.hpp"

namespace cairn::recording {
namespace {

using std::chrono::milliseconds;

/// A sensor that sends a packet every 100 ms of virtual time, with a fault now and then. Who does not wait gets those
/// that are `waiting` alone.
class Sensor final : public Source {
 public:
  explicit Sensor(VirtualClock& clock) : clock_(clock) {}
  Result<Poll> next(Packet& packet, Duration timeout) override {
    if (timeout == Duration::zero() && waiting-- <= 0) return Poll::kTimeout;
    clock_.advance_to(clock_.now() + milliseconds(100));
    if (++calls_ == fault_at) return Error{Errc::kLinkDown, "unplugged"};
    if (calls_ % 10 == 5) return Poll::kTimeout;
    if (calls_ == end_at) return Poll::kEnd;
    packet = {};
    packet.channel = 2368;
    packet.sequence = sent++;
    packet.arrival = clock_.now() - age;
    packet.bytes.assign(1206, std::byte{7});
    return Poll::kPacket;
  }
  int fault_at = -1, end_at = -1, waiting = 0;
  Duration age{};  ///< of a packet when it is handed on
  std::uint64_t sent = 0;

 private:
  VirtualClock& clock_;
  int calls_ = 0;
};

struct Fixture {
  test::TemporaryFolder folder;
  VirtualClock clock;
  Sensor sensor{clock};
  RecordOptions options;
  Fixture() { clock.advance_to(Time(std::chrono::seconds(5000))); }

  [[nodiscard]] Result<RecordReport> record_it() {
    Recording r;
    r.robot = "robot_1";
    r.realtime_offset_ns = 1'700'000'000'000'000'000;
    r.sources.push_back({"lidar", kVelodyne, "lidar.pcap", "lidar", "VLP-16"});
    auto writer = RecordingWriter::create(folder / "r", r);
    return record(sensor, clock, *writer, options);
  }
  [[nodiscard]] std::vector<Packet> replayed() const {
    std::vector<Packet> packets;
    auto reader = RecordingReader::open(folder / "r");
    for (Packet p; *(*reader)->next(p, {}) == Poll::kPacket;) packets.push_back(p);
    return packets;
  }
};

TEST(Record, StopsAfterItsTimeWithEveryPacketOnTheRobotsTimeLine) {
  Fixture f;
  f.options.length = std::chrono::seconds(10);
  int seconds = 0;
  f.options.on_second = [&](Duration since_start) { EXPECT_EQ(since_start, std::chrono::seconds(++seconds)); };
  const auto report = f.record_it();
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->length, std::chrono::seconds(10));
  EXPECT_EQ(seconds, 9);
  const auto packets = f.replayed();
  ASSERT_EQ(packets.size(), f.sensor.sent);
  EXPECT_EQ(packets.front().arrival, Time(milliseconds(5'000'100)));
  EXPECT_EQ(packets.back().arrival, Time(milliseconds(5'010'000)));
}

TEST(Record, StopsWhenTold) {
  Fixture f;
  f.options.stop = [&] { return f.sensor.sent == 17; };
  ASSERT_TRUE(f.record_it());
  EXPECT_EQ(f.replayed().size(), 17U);
}

TEST(Record, WhatHadComeWhenItWasToldToStopIsWrittenAndNothingLater) {
  for (const auto age : {std::chrono::seconds(1), std::chrono::seconds(0)}) {
    Fixture f;
    f.sensor.waiting = 2;
    f.options.stop = [&] {
      f.sensor.age = age;
      return f.sensor.sent == 17;
    };
    ASSERT_TRUE(f.record_it());
    EXPECT_EQ(f.replayed().size(), age > Duration::zero() ? 19U : 17U);
  }
}

TEST(Record, AFaultAtTheEndCostsNothingThatWaits) {
  Fixture f;
  f.sensor.waiting = 3;
  f.options.stop = [&] {
    f.sensor.age = std::chrono::seconds(1);
    f.sensor.fault_at = 19 + 2;  // the 18th packet is the 19th call or later; two calls timed out before
    return f.sensor.sent == 17;
  };
  ASSERT_TRUE(f.record_it());
  EXPECT_EQ(f.replayed().size(), 19U);
}

TEST(Record, ASourceThatNeverFallsSilentDoesNotKeepItFromStopping) {
  Fixture f;
  f.sensor.waiting = 1 << 30;
  f.options.stop = [&] { return f.sensor.sent == 17; };
  ASSERT_TRUE(f.record_it());
}

TEST(Record, AnErrorOfTheSourceIsCountedAndItGoesOn) {
  Fixture f;
  f.sensor.fault_at = 3;
  f.sensor.end_at = 28;
  const auto report = f.record_it();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->source_errors, 1U);
  EXPECT_EQ(report->first_error, "unplugged");
  EXPECT_EQ(f.replayed().size(), 28U - 5U);
}

TEST(Record, WhatIsRecordedIsOnDiskASecondLater) {
  Fixture f;
  f.options.stop = [&] {
    if (f.clock.now() >= Time(milliseconds(5'003'000))) {
      EXPECT_GT(test::fs::file_size(f.folder / "r/lidar.pcap"), 15U * 1206U);
    }
    return f.clock.now() > Time(milliseconds(5'003'000));
  };
  ASSERT_TRUE(f.record_it());
}

TEST(Record, AnErrorOfTheWriterEndsItAndKeepsWhatWasBefore) {
  Fixture f;
  f.options.stop = [&] {
    if (f.sensor.sent == 20) f.clock.advance_to(Time(std::chrono::hours(24 * 365 * 80)));  // no pcap stamp can say that
    return false;
  };
  const auto report = f.record_it();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kLimit);
  EXPECT_EQ(f.replayed().size(), 20U);
}

}  // namespace
}  // namespace cairn::recording

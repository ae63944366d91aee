// SPDX-License-Identifier: Apache-2.0
// The receive task by itself: what it makes of GPIO lines and of satellite fixes.
#include "onboard/app/tasks/receive_task.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "onboard/scheduler/channel.hpp"

namespace cairn::app {
namespace {

using namespace std::chrono_literals;
using scheduler::Regime;
using scheduler::Tick;
using scheduler::TickRecord;

/// Packets that a test puts there.
class Waiting final : public Source {
 public:
  Result<Poll> next(Packet& packet, Duration /*timeout*/) override {
    if (packets.empty()) return Poll::kTimeout;
    packet = packets.front();
    packets.pop_front();
    return Poll::kPacket;
  }
  std::deque<Packet> packets;
};

/// A decoder that knows a place with each packet, and keeps the seconds that it is told.
class KnowingDecoder final : public ScanDecoder {
 public:
  explicit KnowingDecoder(std::vector<Time>& seconds) : seconds_(seconds) {}
  Result<const Scan*> decode(const Packet& packet) override {
    fix_ = GeoFix{packet.arrival, 1, 2};
    return static_cast<const Scan*>(nullptr);
  }
  const Scan* expire(Time /*now*/) override { return nullptr; }
  const Scan* flush() override { return nullptr; }
  void note_second(Time at) override { seconds_.push_back(at); }
  std::optional<GeoFix> take_fix() override { return std::exchange(fix_, std::nullopt); }

 private:
  std::vector<Time>& seconds_;
  std::optional<GeoFix> fix_;
};

/// The tasks around it.
struct Neighbours final : scheduler::Task {
  void tick(Tick& /*tick*/) override {}
  scheduler::OutputPort<LineEdge> lines{*this, "lines"};
  scheduler::InputPort<ArrivedPicture> pictures{*this, "pictures"};
  scheduler::InputPort<GeoFix> fixes{*this, "fixes"};
  scheduler::Progress nobody;
  scheduler::Channel<LineEdge> lines_channel{{.capacity = 128}, nobody, nobody};
  scheduler::Channel<ArrivedPicture> pictures_channel{{.capacity = 8}, nobody, nobody};
  scheduler::Channel<GeoFix> fixes_channel{{.capacity = 8}, nobody, nobody};
};

class ReceiveTaskTest : public ::testing::Test {
 protected:
  ReceiveTaskTest() {
    around_.lines.connect(around_.lines_channel);
    task_.lines.connect(around_.lines_channel);
    task_.pictures.connect(around_.pictures_channel);
    around_.pictures.connect(around_.pictures_channel);
    task_.fixes.connect(around_.fixes_channel);
    around_.fixes.connect(around_.fixes_channel);
  }
  Waiting& add(recording::SensorKind kind) {
    Input& input = inputs_.emplace_back();
    input.entry.id = to_string(kind);
    input.entry.kind = kind;
    auto source = std::make_unique<Waiting>();
    Waiting& waiting = *source;
    input.source = std::move(source);
    if (kind == recording::kVelodyne) input.scans = std::make_unique<KnowingDecoder>(seconds_);
    EXPECT_TRUE(task_.add(input, static_cast<SourceId>(inputs_.size() - 1), {}));
    return waiting;
  }
  static void arrive(Waiting& waiting, Time at) {
    Packet& packet = waiting.packets.emplace_back();
    packet.arrival = at;
    packet.bytes.assign(64, std::byte{static_cast<unsigned char>(at.time_since_epoch() / 1ms)});
  }
  void rise(gpio::Line line, Time at) {
    Tick tick(Regime::kLive, at, record_);
    LineEdge* edge = around_.lines.back(tick);
    ASSERT_NE(edge, nullptr);
    *edge = {line, at};
    around_.lines.push(tick);
  }
  void tick(Time now) {
    TickRecord record;
    record.index = ++index_;
    Tick tick(Regime::kLive, now, record);
    task_.tick(tick);
  }
  std::optional<Time> picture() {
    TickRecord record;
    record.index = ++index_;
    Tick tick(Regime::kLive, now_, record);
    const ArrivedPicture* picture = around_.pictures.take(tick);
    const auto at = picture != nullptr ? std::optional(picture->packet.arrival) : std::nullopt;
    around_.pictures.give_back(tick);
    return at;
  }

  Monitor monitor_;
  ReceiveTask task_{monitor_};
  Neighbours around_;
  std::deque<Input> inputs_;
  std::vector<Time> seconds_;
  TickRecord record_;
  Time now_{100s};
  std::uint64_t index_ = 0;
};

TEST_F(ReceiveTaskTest, ATriggeredPictureHasTheTimeOfItsPulse) {
  task_.expose_by_trigger(recording::kCamera, 7ms);
  Waiting& camera = add(recording::kCamera);
  for (const Duration since : {0ms, 100ms, 200ms}) rise(gpio::Line::kTrigger, now_ + since);
  arrive(camera, now_ + 133ms);
  tick(now_ + 250ms);
  EXPECT_EQ(picture(), now_ + 107ms) << "its decoder takes 7 ms off";
  arrive(camera, now_ + 900ms);
  tick(now_ + 950ms);
  EXPECT_EQ(picture(), now_ + 900ms) << "the trigger was quiet for too long";
  ASSERT_EQ(monitor_.events().size(), 1U);
  EXPECT_NE(monitor_.events()[0].what.find("without a pulse"), std::string::npos);
}

/// A picture that takes longer than a period has an earlier pulse, and the known delay tells which.
TEST_F(ReceiveTaskTest, ASlowPictureHasAnEarlierPulse) {
  task_.expose_by_trigger(recording::kCamera, 140ms);
  Waiting& camera = add(recording::kCamera);
  for (const Duration since : {0ms, 100ms, 200ms}) rise(gpio::Line::kTrigger, now_ + since);
  arrive(camera, now_ + 233ms);
  tick(now_ + 250ms);
  EXPECT_EQ(picture(), now_ + 240ms) << "of the pulse at 100 ms";
}

TEST_F(ReceiveTaskTest, OtherPicturesKeepTheirTime) {
  Waiting& camera = add(recording::kCamera);
  rise(gpio::Line::kTrigger, now_);
  arrive(camera, now_ + 33ms);
  tick(now_ + 50ms);
  EXPECT_EQ(picture(), now_ + 33ms);
  EXPECT_TRUE(monitor_.events().empty());
}

TEST_F(ReceiveTaskTest, RegularPulsesPerSecondGoToTheLidar) {
  (void)add(recording::kVelodyne);
  for (int i = 0; i < 6; ++i) rise(gpio::Line::kPps, now_ + i * 1s);
  rise(gpio::Line::kPps, now_ + 5400ms);
  tick(now_ + 6s);
  EXPECT_EQ(seconds_, (std::vector<Time>{now_ + 3s, now_ + 4s, now_ + 5s})) << "after three good intervals";
}

TEST_F(ReceiveTaskTest, FixesOfSatellitesAreHandedOn) {
  Waiting& lidar = add(recording::kVelodyne);
  arrive(lidar, now_);
  tick(now_ + 1ms);
  TickRecord record;
  record.index = ++index_;
  Tick tick(Regime::kLive, now_, record);
  const GeoFix* fix = around_.fixes.take(tick);
  ASSERT_NE(fix, nullptr);
  EXPECT_EQ(fix->stamp, now_);
  EXPECT_EQ(fix->longitude_deg, 2);
}

}  // namespace
}  // namespace cairn::app

// SPDX-License-Identifier: Apache-2.0
// The streams task with real clients, in virtual time.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

#include "onboard/app/streams/streams_task.hpp"
#include "onboard/client/map_mirror.hpp"
#include "onboard/client/robot_stream.hpp"
#include "tests/support/temporary_folder.hpp"

namespace cairn::app::test {

using client::RobotStream;
using clients::Stream;
using clients::SubscribeMessage;
using std::chrono::milliseconds;

inline SubscribeMessage wanted(std::initializer_list<Stream> streams) {
  SubscribeMessage wants;
  for (const Stream stream : streams) wants.add(stream);
  return wants;
}

class StreamsRig : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kSession = 77, kSelf = 3;

  StreamsRig()
      : task_(ClientHub::open(folder_ / "", {.robot = "husky", .session = kSession, .resolution_m = 0.2}, monitor_)
                  .value(),
              kSession, kSelf, outlets_, monitor_) {}

  RobotStream connect(const SubscribeMessage& wants) {
    return RobotStream::connect(folder_ / "robot.sock", wants).value();
  }
  /// Some ticks of the task.
  void run(int ticks = 4) {
    for (int i = 0; i < ticks; ++i) {
      now_ += milliseconds(5);
      scheduler::TickRecord record;
      scheduler::Tick tick(scheduler::Regime::kLive, now_, record);
      task_.tick(tick);
    }
  }
  /// All messages of a kind that wait for a client.
  template <class Message>
  static std::vector<Message> read(RobotStream& stream) {
    std::vector<Message> messages;
    for (;;) {
      auto next = stream.next(Duration{});
      EXPECT_TRUE(next);
      if (!next || std::holds_alternative<std::monostate>(*next)) return messages;
      if (std::holds_alternative<client::CoreGone>(*next)) return messages;
      if (auto* message = std::get_if<Message>(&*next)) messages.push_back(std::move(*message));
    }
  }
  void locate(int scan) {
    PoseNews* news = outlets_.poses.back();
    ASSERT_NE(news, nullptr);
    *news = {};
    news->point.stamp = Time{milliseconds(100 * scan)};
    news->point.epoch = 1;
    news->filter.reset({}, {});
    outlets_.poses.push();
  }
  void map(std::uint32_t epoch, std::uint64_t first, std::uint64_t count, unsigned voxel = 0) {
    std::vector<mapping::TileKey> keys;
    for (std::uint64_t i = 0; i < count; ++i) keys.push_back({first + i});
    outlets_.own.begin(epoch);
    outlets_.own.owe(keys);
    outlets_.own.hand_over(count, [&](TileNews& news) {
      news.state = {};
      news.state.set(voxel, 1, 2, 3.5F);
      news.state.set(3, static_cast<unsigned>(news.tile.morton % 8), 2, -1.6F);
    });
  }
  static void take_in(RobotStream& stream, client::MapMirror& mirror) {
    for (const auto& message : read<clients::TilesMessage>(stream)) ASSERT_TRUE(mirror.take(message));
  }

  support::TemporaryFolder folder_;
  Monitor monitor_;
  StreamOutlets outlets_;
  StreamsTask task_;
  Time now_{};
};

}  // namespace cairn::app::test

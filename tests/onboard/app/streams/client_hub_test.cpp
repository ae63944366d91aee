// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/streams/client_hub.hpp"

#include "tests/onboard/app/streams/streams_rig.hpp"

namespace cairn::app {
namespace {

using test::RobotStream;
using test::Stream;
using test::wanted;

class ClientHubTest : public test::StreamsRig {};

TEST_F(ClientHubTest, GarbageEndsAConnectionAndIsCountedOnce) {
  for (int i = 0; i < 5; ++i) {
    auto hostile = clients::LocalClient::connect(folder_ / "robot.sock").value();
    run();
    EXPECT_TRUE(hostile.send(std::vector<std::byte>(100, std::byte{0x55})));
    run();
    std::vector<std::byte> bytes;
    while (hostile.receive(bytes, 1000, Duration{}) == clients::LocalClient::Got::kMessage) continue;
    EXPECT_EQ(hostile.receive(bytes, 1000, Duration{}), clients::LocalClient::Got::kEnd);
  }
  ASSERT_EQ(monitor_.events().size(), 1U);
  EXPECT_EQ(monitor_.events()[0].count, 5U);
}

TEST_F(ClientHubTest, ThoseWhoJoinKeepNobodyFromBeingHeard) {
  RobotStream first = connect(wanted({Stream::kPose}));
  run(1);
  std::vector<clients::LocalClient> crowd;
  for (int i = 0; i < 20; ++i) crowd.push_back(clients::LocalClient::connect(folder_ / "robot.sock").value());
  EXPECT_TRUE(first.subscribe(wanted({Stream::kEvents})));
  monitor_.event({}, "odometry", "lost");
  run(2);
  EXPECT_EQ(outlets_.scans_wanted, false);
  EXPECT_TRUE(first.subscribe(wanted({Stream::kScan})));
  run(2);
  EXPECT_EQ(outlets_.scans_wanted, true) << "while others wait to join";
  EXPECT_LE(read<clients::HelloMessage>(first).size(), 1U);
}

TEST_F(ClientHubTest, ThereIsRoomForSoManyClients) {
  std::vector<RobotStream> streams;
  for (std::size_t i = 0; i < ClientHub::kMostClients; ++i) {
    streams.push_back(connect(wanted({Stream::kPose})));
    run(1);
  }
  run();
  RobotStream further = connect(wanted({Stream::kPose}));
  run();
  locate(1);
  run();
  for (RobotStream& stream : streams) EXPECT_EQ(read<clients::PoseMessage>(stream).size(), 1U);
  EXPECT_EQ(read<clients::PoseMessage>(further).size(), 0U);
  EXPECT_FALSE(further.connected());
  EXPECT_EQ(monitor_.events().size(), 1U);
}

}  // namespace
}  // namespace cairn::app

// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/stream/pose_command.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <sstream>

#include "drivers/clients/commands/command_socket.hpp"

#include "tests/tools/cli/stream/core_stand_in.hpp"

namespace cairn::cli {
namespace {

using ::testing::HasSubstr;

void locate_each_tick(app::StreamOutlets& outlets, int tick) {
  app::PoseNews* news = outlets.poses.back();
  if (news == nullptr) return;
  *news = {};
  news->point.stamp = Time{std::chrono::milliseconds(100 * (tick + 1))};
  news->point.T_odom_base.mean = SE3::from_xyz_rpy((Vector6() << 1, 2, 3, 0, 0, 0).finished());
  news->point.twist << 0.5, 0, 0, 0, 0, 0;
  outlets.poses.push();
}
void nothing_ever(app::StreamOutlets& /*outlets*/, int /*tick*/) {}

TEST(PoseCommand, PrintsALineForEachPose) {
  const Outcome o = test::run_beside_core(add_pose_command, {"pose", "--seconds", "0.2"}, locate_each_tick);
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  EXPECT_THAT(o.out, HasSubstr("x 1.000  y 2.000  z 3.000 m"));
}

TEST(PoseCommand, JsonIsOneObjectALine) {
  const Outcome o = test::run_beside_core(add_pose_command, {"pose", "--seconds", "0.2", "--json"}, locate_each_tick);
  EXPECT_EQ(o.exit_code, app::kDone) << o.err;
  std::istringstream lines(o.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(json.is_object()) << line;
    EXPECT_EQ(json["xyz"], (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(json["quaternion_xyzw"], (std::vector<double>{0, 0, 0, 1}));
    EXPECT_EQ(json["covariance_diagonal"].size(), 6U);
    EXPECT_EQ(json["twist"][0], 0.5);
    EXPECT_EQ(json["predicted"], false);
    EXPECT_EQ(json["lost"], false);
    EXPECT_EQ(json["utc_ns"].get<std::int64_t>() > json["stamp_ns"].get<std::int64_t>(), true);
  }
  EXPECT_GT(count, 0);
}

TEST(PoseCommand, SaysThatNoPoseCame) {
  const Outcome o = test::run_beside_core(add_pose_command, {"pose", "--seconds", "0.1"}, nothing_ever);
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("no pose came in time"));
}

TEST(PoseCommand, OnTheSocketForCommandsItNamesTheOther) {
  const TemporaryFolder folder;
  const LiveClock clock;
  const auto socket = clients::CommandSocket::open(folder / "command.sock", SourceId{}, clock).value();
  Outcome outcome{};
  std::atomic<bool> done{false};
  Workers(2).for_each(2, [&](std::size_t side) {
    if (side == 0) {
      outcome = run(add_pose_command, {"pose", "--seconds", "5", "--socket", folder / "command.sock"});
      done = true;
    }
    Packet packet;
    while (!done) (void)socket->next(packet, {});
  });
  EXPECT_EQ(outcome.exit_code, app::kWrongArguments);
  EXPECT_THAT(outcome.err, HasSubstr("robot.sock"));
}

TEST(PoseCommand, WithoutACoreItSaysSo) {
  const TemporaryFolder folder;
  const Outcome o = run(add_pose_command, {"pose", "--socket", (folder / "robot.sock").string()});
  EXPECT_EQ(o.exit_code, app::kFailed);
  EXPECT_THAT(o.err, HasSubstr("no core serves this socket"));
  EXPECT_THAT(o.err, HasSubstr("--sockets"));
}

TEST(PoseCommand, RefusesARateThatNoCoreHas) {
  EXPECT_EQ(run(add_pose_command, {"pose", "--rate", "500"}).exit_code, app::kWrongArguments);
  EXPECT_EQ(run(add_pose_command, {"pose", "--seconds", "0"}).exit_code, app::kWrongArguments);
}

}  // namespace
}  // namespace cairn::cli

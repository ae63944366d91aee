// SPDX-License-Identifier: Apache-2.0
// Follows the pose of a running core:  follow_pose [SOCKET] [HZ]
// HZ: how often, between scans, too; without it, once a scan.
#include <cairn/onboard/client/robot_stream.hpp>
#include <cstdio>
#include <cstdlib>

namespace {

using namespace cairn;

int fail(const Error& error) {
  std::fprintf(stderr, "%s\n", to_string(error).c_str());
  return 1;
}

void show(const client::PoseMessage& pose) {
  const Vector6 p = pose.T_odom_base.mean.xyz_rpy();
  std::printf("%.3f s: x %.3f y %.3f m, yaw %.4f rad (1 sigma %.3f m), %.2f m/s%s%s\n", to_seconds(pose.stamp), p[0],
              p[1], p[5], std::sqrt(pose.T_odom_base.covariance(0, 0)), pose.twist[0],
              pose.predicted ? ", predicted" : "", pose.lost ? ", LOST" : "");
}

void show(const client::StateMessage& state) {
  std::printf("mode %s%s%s\n", std::string(to_string(state.mode)).c_str(), state.cause.empty() ? "" : ": ",
              state.cause.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  client::SubscribeMessage wants;
  wants.add(clients::Stream::kPose);
  wants.add(clients::Stream::kState);
  if (argc > 2) wants.pose_hz = std::atof(argv[2]);
  auto robot = client::RobotStream::connect(argc > 1 ? argv[1] : client::kRobotSocket, wants);
  if (!robot) return fail(robot.error());
  for (;;) {
    const auto message = robot->next(std::chrono::seconds(1));
    if (!message) return fail(message.error());
    if (const auto* hello = std::get_if<client::HelloMessage>(&*message))
      std::printf("robot %s\n", hello->robot.c_str());
    if (const auto* pose = std::get_if<client::PoseMessage>(&*message)) show(*pose);
    if (const auto* state = std::get_if<client::StateMessage>(&*message)) show(*state);
    if (std::holds_alternative<client::CoreGone>(*message)) return std::printf("the core has gone\n"), 0;
    std::fflush(stdout);
  }
}

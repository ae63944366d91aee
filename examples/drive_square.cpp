// SPDX-License-Identifier: Apache-2.0
// Drives a square: reads the robot's pose from robot.sock, and sends velocities to command.sock.
//   drive_square SOCKETS [SIDE_M]       SOCKETS: the folder of the core's --sockets
// Prints each corner with the time of its pose. Exit code 1: the robot was stopped, or the core is gone.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "drivers/clients/commands/command_client.hpp"
#include "onboard/client/robot_stream.hpp"

namespace {

using namespace cairn;
using namespace std::chrono_literals;

constexpr double kPose_hz = 50, kRest_s = 1, kPatience_s = 60;
constexpr double kSpeed = 0.5, kTurn = 0.6;                                 // m/s and rad/s at most
constexpr double kSlow = 0.05, kSlowTurn = 0.06;                            // at least, or the robot would never arrive
constexpr double kGain = 1, kTurnGain = 2, kNear = 0.02, kStraight = 0.01;  // 1/s; m and rad: there

double towards(double error, double gain, double least, double most) {
  return std::copysign(std::clamp(std::abs(gain * error), least, most), error);
}

struct Robot {
  client::RobotStream poses;
  clients::CommandClient commands;
  client::PoseMessage pose{};

  /// The next prediction: those are one line of time.
  bool look() {
    for (;;) {
      const auto message = poses.next(1s);
      if (!message || std::holds_alternative<client::CoreGone>(*message)) return false;
      const auto* next = std::get_if<client::PoseMessage>(&*message);
      if (next == nullptr || !next->predicted) continue;
      pose = *next;
      return true;
    }
  }
  /// Commands a velocity, and looks where that leads. False also when the robot was stopped.
  bool move(double v, double w) {
    bool stopped = !commands.drive(v, w);
    while (const auto answer = commands.next_answer(0s)) stopped = stopped || answer->stopped;
    return !stopped && look();
  }
};

/// Drives to (x, y) of the square's frame, then turns to `yaw`, and rests.
bool reach(Robot& robot, const SE3& T_odom_square, const Eigen::Vector2d& goal, double yaw) {
  const auto at = [&] { return (T_odom_square.inverse() * robot.pose.T_odom_base.mean).xyz_rpy(); };
  const auto off = [&](double wanted) { return std::remainder(wanted - at()[5], 2 * std::numbers::pi); };
  for (int looks = 0;; ++looks) {
    const Eigen::Vector2d way = goal - at().head<2>();
    const double bearing = off(std::atan2(way.y(), way.x()));
    if (way.norm() < kNear || std::abs(bearing) > std::numbers::pi / 2) break;  // there, or just past it
    const double v = towards(way.norm(), kGain, kSlow, kSpeed);
    if (looks > kPatience_s * kPose_hz) return false;  // something is in the way
    if (!robot.move(v, std::clamp(kTurnGain * bearing, -kTurn, kTurn))) return false;
  }
  while (std::abs(off(yaw)) > kStraight)
    if (!robot.move(0, towards(off(yaw), kTurnGain, kSlowTurn, kTurn))) return false;
  for (int i = 0; i < kRest_s * kPose_hz; ++i)
    if (!robot.move(0, 0)) return false;
  std::printf("%lld ns: x %.3f m, y %.3f m, yaw %.3f rad\n",
              static_cast<long long>(robot.pose.stamp.time_since_epoch().count()), at()[0], at()[1], at()[5]);
  return true;
}

int fail(const Error& error) { return std::fprintf(stderr, "drive_square: %s\n", to_string(error).c_str()), 1; }

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "drive_square SOCKETS [SIDE_M]\n"), 2;
  const std::filesystem::path sockets = argv[1];
  const double side = argc > 2 ? std::strtod(argv[2], nullptr) : 2;
  clients::SubscribeMessage wants;
  wants.pose_hz = kPose_hz;
  wants.add(clients::Stream::kPose);
  const LiveClock clock;
  auto poses = client::RobotStream::connect(sockets / "robot.sock", wants);
  if (!poses) return fail(poses.error());
  auto commands = clients::CommandClient::connect(sockets / "command.sock", "drive_square", clock);
  if (!commands) return fail(commands.error());
  if (const auto armed = commands->arm(5s); !armed) return fail(armed.error());

  Robot robot{std::move(*poses), std::move(*commands)};
  if (!robot.look()) return 1;
  const SE3 start = robot.pose.T_odom_base.mean;
  const std::array<Eigen::Vector2d, 4> corners{{{side, 0}, {side, side}, {0, side}, {0, 0}}};
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (!reach(robot, start, corners.at(i), static_cast<double>(i + 1) * std::numbers::pi / 2)) return 1;
  return 0;
}

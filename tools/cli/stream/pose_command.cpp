// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/stream/pose_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "hal/clock.hpp"
#include "tools/cli/stream/core_stream.hpp"

namespace cairn::cli {
namespace {

using client::PoseMessage;

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr Duration kPosesWithin = std::chrono::seconds(5);

struct PoseArguments {
  std::filesystem::path socket;
  bool json = false;
  double rate_hz = 0;
  std::optional<double> seconds;
};

std::vector<double> numbers(const Eigen::Ref<const Eigen::VectorXd>& v) { return {v.data(), v.data() + v.size()}; }

std::string json_line(const PoseMessage& pose, Duration realtime_offset) {
  const std::int64_t stamp_ns = pose.stamp.time_since_epoch().count();
  const nlohmann::ordered_json line = {{"stamp_ns", stamp_ns},
                                       {"utc_ns", stamp_ns + realtime_offset.count()},
                                       {"xyz", numbers(pose.T_odom_base.mean.translation())},
                                       {"quaternion_xyzw", numbers(pose.T_odom_base.mean.quaternion().coeffs())},
                                       {"covariance_diagonal", numbers(pose.T_odom_base.covariance.diagonal())},
                                       {"twist", numbers(pose.twist)},
                                       {"epoch", pose.epoch},
                                       {"degenerate_directions", pose.degenerate_directions},
                                       {"lost", pose.lost},
                                       {"predicted", pose.predicted}};
  return line.dump();
}

std::string text_line(const PoseMessage& pose) {
  const Vector6 at = pose.T_odom_base.mean.xyz_rpy();
  const Matrix6& P = pose.T_odom_base.covariance;
  return fmt::format(
      "{:.3f} s  x {:.3f}  y {:.3f}  z {:.3f} m  yaw {:.2f} deg  +-{:.3f} m  v {:.2f} m/s  w {:.1f} deg/s{}{}",
      to_seconds(pose.stamp), at[0], at[1], at[2], at[5] * kDegPerRad, std::sqrt(P.topLeftCorner<3, 3>().trace()),
      pose.twist[0], pose.twist[5] * kDegPerRad, pose.lost ? "  lost" : "", pose.predicted ? "  predicted" : "");
}

/// Prints what comes and knows when it is enough.
class PosePrinter {
 public:
  explicit PosePrinter(const PoseArguments& arguments) : a_(arguments), start_(LiveClock().now()) {}

  Result<bool> take(const client::StreamMessage& message) {
    if (const auto* hello = std::get_if<client::HelloMessage>(&message)) realtime_offset_ = hello->realtime_offset;
    const auto* pose = std::get_if<PoseMessage>(&message);
    if (pose == nullptr) return true;
    ++poses_;
    std::cout << (a_.json ? json_line(*pose, realtime_offset_) : text_line(*pose)) << std::endl;
    return static_cast<bool>(std::cout);  // whoever read is gone
  }
  Result<bool> idle() {
    const Duration passed = LiveClock().now() - start_;
    if (poses_ == 0 && !complained_ && passed > kPosesWithin) {
      complained_ = true;
      std::cerr << "cairn: no pose yet: the core has located no scan; `cairn top` shows why\n";
    }
    return !a_.seconds || to_seconds(passed) < *a_.seconds;
  }
  [[nodiscard]] std::uint64_t poses() const { return poses_; }

 private:
  const PoseArguments& a_;
  Time start_;
  Duration realtime_offset_{};
  std::uint64_t poses_ = 0;
  bool complained_ = false;
};

int show_poses(const PoseArguments& a) {
  client::SubscribeMessage wants;
  wants.add(clients::Stream::kPose);
  wants.pose_hz = a.rate_hz;
  PosePrinter printer(a);
  std::uint64_t lost = 0;
  const auto read = read_core(
      a.socket, wants, [&](client::StreamMessage& message) { return printer.take(message); },
      [&] { return printer.idle(); }, &lost);
  if (lost > 0) std::cerr << "cairn: " << lost << " records were lost: this reader was too slow\n";
  if (!read) return app::fail(read.error());
  if (printer.poses() > 0 || !a.seconds) return app::kDone;
  return app::fail({Errc::kNotFound, "no pose came in time", a.socket.string(), {}, "`cairn top` shows why"});
}

}  // namespace

void add_pose_command(app::Commands& commands) {
  auto* sub = commands.app.add_subcommand("pose", "prints the poses of a running core, one a line");
  auto a = std::make_shared<PoseArguments>();
  sub->add_option("--socket", a->socket, "socket of the core: robot.sock in the folder of its --sockets")
      ->default_val(client::kRobotSocket);
  sub->add_flag("--json", a->json, "one JSON object a line");
  sub->add_option("--rate", a->rate_hz, "predictions, too, so often a second; without it: the pose of each scan")
      ->check(CLI::Range(0.0, client::SubscribeMessage::kMaxPose_hz));
  sub->add_option("--seconds", a->seconds, "end after so many seconds; without it: at Ctrl-C")->check(app::above_zero);
  sub->callback([&commands, a] { commands.job = [a] { return show_poses(*a); }; });
}

}  // namespace cairn::cli

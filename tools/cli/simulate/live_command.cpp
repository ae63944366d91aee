// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/simulate/live_command.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "onboard/app/cli/command.hpp"
#include "onboard/app/live/stop_signal.hpp"

namespace cairn::cli {
namespace {

using simulator::GroundPose;
using simulator::LiveDevices;
using simulator::LiveSummary;

/// An option that the other kind of simulation has, and what to do instead.
struct Foreign {
  const char* option;
  const char* remedy;
};
constexpr std::array kForRecordings{
    Foreign{"--out", "nothing is recorded; record with: cairn run --config FILE --record DIR"},
    Foreign{"--name", "the profile of the robot's program has its name"},
    Foreign{"--robots", "start one simulation for each robot, each with its own --to, --can and --estop"},
    Foreign{"--people", "nobody walks in a live world"},
    Foreign{"--people-pause", "nobody walks in a live world"},
    Foreign{"--screens", "a live world has none"},
    Foreign{"--night", "a live robot has no camera"},
    Foreign{"--profile", "a live robot is a husky"},
    Foreign{"--motion", "the robot moves as its motors are told"},
    Foreign{"--sensors", "a live robot has lidar, drive and gpio"},
    Foreign{"--camera-rate", "a live robot has no camera"},
    Foreign{"--separate-eyes", "a live robot has no camera"},
    Foreign{"--camera-noise", "a live robot has no camera"},
    Foreign{"--exposure", "a live robot has no camera"},
    Foreign{"--exposure-error", "a live robot has no camera"},
    Foreign{"--line-time", "a live robot has no camera"},
    Foreign{"--thermal-rate", "a live robot has no camera"},
    Foreign{"--threads", "one thread plays the world"},
};
constexpr std::array kForLive{"--to", "--can", "--estop", "--start", "--truth", "--profile-out"};

/// HOST:PORT, or HOST alone.
Result<simulator::UdpTarget> target_of(const std::string& text) {
  simulator::UdpTarget target;
  const std::size_t colon = text.rfind(':');
  target.host = text.substr(0, colon);
  if (colon == std::string::npos) return target;
  const char *first = text.data() + colon + 1, *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, target.data_port);
  if (error == std::errc{} && end == last && target.data_port > 0 && target.data_port < 65536) return target;
  return Error{Errc::kInvalidConfig, "no UDP port", "--to " + text, {}, "HOST:PORT is expected, as in 127.0.0.1:2368"};
}

Result<simulator::LiveConfig> config_of(const LiveArguments& arguments) {
  simulator::LiveConfig config = arguments.config;
  auto target = target_of(arguments.to);
  if (!target) return target.error();
  config.to = std::move(*target);
  if (arguments.start.empty()) return config;
  const GroundPose start{arguments.start[0], arguments.start[1], arguments.start[2]};
  if (!std::isfinite(start.x) || !std::isfinite(start.y) || !(std::abs(start.yaw) <= 2 * std::numbers::pi))
    return Error{Errc::kInvalidConfig, "no place to start", "--start", {}, "x,y in metres and yaw in radians"};
  config.start = start;
  return config;
}

/// `folder`: where the simulated devices are, and so a fit place for the sockets of the robot's program.
void show_next_steps(const std::filesystem::path& profile, const std::filesystem::path& folder) {
  const std::string socket = (folder / "command.sock").string();
  std::printf("then, in other terminals:\n");
  std::printf("  cairn run --config %s --sockets %s --out run\n", profile.c_str(), folder.c_str());
  std::printf("  cairn arm --socket %s\n", socket.c_str());
  std::printf("  cairn drive --v 0.5 --seconds 3 --socket %s\n", socket.c_str());
}

void show(const simulator::LiveConfig& config, const LiveDevices& d) {
  std::printf("%s: the robot stands at x %.2f m, y %.2f m, yaw %.1f deg\n", config.scene.c_str(), d.start.x, d.start.y,
              d.start.yaw * 180 / std::numbers::pi);
  std::printf("LiDAR:  VLP-16, packets to %s, ports %d and %d\n", d.lidar.host.c_str(), d.lidar.data_port,
              d.lidar.position_port());
  std::printf("drive:  two CiA 402 motors on the CAN bus %s\n", d.can.c_str());
  std::printf("e-stop: %s; `echo 0 > %s` presses it, `echo 1` releases it\n", d.pressed ? "pressed" : "released",
              d.estop.c_str());
  if (!config.profile.empty()) show_next_steps(config.profile, d.estop.parent_path());
  std::printf("Ctrl-C ends the simulation\n");
  std::fflush(stdout);
}

double milliseconds(Duration d) { return 1e3 * to_seconds(d); }

nlohmann::ordered_json to_json(const simulator::LiveConfig& config, const LiveSummary& s) {
  return {{"scene", config.scene},
          {"seed", config.seed},
          {"seconds", s.seconds},
          {"distance_m", s.distance_m},
          {"contacts", s.contacts},
          {"end", {s.end.x, s.end.y, s.end.yaw}},
          {"data_packets", s.lidar.data_packets},
          {"position_packets", s.lidar.position_packets},
          {"left_out_packets", s.lidar.left_out},
          {"refused_packets", s.lidar.refused},
          {"late_p50_ms", milliseconds(s.late_p50)},
          {"late_p99_ms", milliseconds(s.late_p99)},
          {"late_max_ms", milliseconds(s.late_max)},
          {"can_frames_received", s.motors.obeyed},
          {"can_frames_sent", s.motors.sent},
          {"can_frames_lost", s.motors.unsent}};
}

void show(const LiveSummary& s) {
  std::printf("%.1f s: %.1f m driven, %d contacts; %llu LiDAR packets (%llu left out), half of them within %.1f ms, ",
              s.seconds, s.distance_m, s.contacts, static_cast<unsigned long long>(s.lidar.data_packets),
              static_cast<unsigned long long>(s.lidar.left_out), milliseconds(s.late_p50));
  std::printf("99 %% within %.1f ms, all within %.1f ms; %llu CAN frames came, %llu went, %llu were lost\n",
              milliseconds(s.late_p99), milliseconds(s.late_max), static_cast<unsigned long long>(s.motors.obeyed),
              static_cast<unsigned long long>(s.motors.sent), static_cast<unsigned long long>(s.motors.unsent));
}

}  // namespace

void add_live_options(CLI::App& sub, LiveArguments& a) {
  const char* group = "A robot to drive";
  sub.add_flag("--live", a.live,
               "plays the world in real time as devices: a robot's program drives the robot and sees the world")
      ->group(group);
  sub.add_option("--to", a.to, "address and port that the LiDAR's packets go to")
      ->type_name("HOST:PORT")
      ->capture_default_str()
      ->group(group);
  sub.add_option("--can", a.config.can,
                 "CAN bus of the motors: unix:PATH, which is played here, or a SocketCAN interface such as vcan0; "
                 "default: a socket of this user's")
      ->group(group);
  sub.add_option("--estop", a.config.estop,
                 "file of the e-stop's line: 1 released, 0 pressed; default: one of this user's")
      ->group(group);
  sub.add_option("--start", a.start, "where the robot stands first: x,y in m, yaw in rad; default: a place of the seed")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,YAW")
      ->group(group);
  sub.add_option("--truth", a.config.truth, "gets the true path, to compare with the run's: FILE.tum")->group(group);
  sub.add_option("--profile-out", a.config.profile, "gets the profile for `cairn run --config`: FILE.yaml")
      ->group(group);
}

Result<void> check_live_options(const CLI::App& sub, bool live) {
  if (live) {
    for (const Foreign& foreign : kForRecordings)
      if (sub.count(foreign.option) > 0)
        return Error{Errc::kInvalidConfig, "does not go with --live", foreign.option, {}, foreign.remedy};
    return {};
  }
  for (const char* option : kForLive)
    if (sub.count(option) > 0)
      return Error{Errc::kInvalidConfig, "is for a live simulation", option, {}, "add --live, or leave it out"};
  if (sub.count("--out") == 0)
    return Error{
        Errc::kInvalidConfig, "is required", "--out", {}, "name a new folder, or add --live for a robot to drive"};
  return {};
}

int run_live(const LiveArguments& arguments, bool json) {
  const auto config = config_of(arguments);
  if (!config) return app::fail(config.error());
  app::catch_stop_signals();
  const auto played = simulator::simulate_live(
      *config, {.stop = app::stop_requested,
                .started = [&](const LiveDevices& devices) { return json ? void() : show(*config, devices); },
                .say = [](const std::string& words) { std::fprintf(stderr, "cairn: %s\n", words.c_str()); }});
  if (!played) return app::fail(played.error());
  if (json) return app::print(to_json(*config, *played));
  show(*played);
  return app::kDone;
}

}  // namespace cairn::cli

// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/simulate/simulate_command.hpp"
#include "tools/simulator/scenes/make_world.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "onboard/app/live/stop_signal.hpp"
#include "tools/cli/simulate/live_command.hpp"
#include "tools/cli/simulate/unused_options.hpp"
#include "tools/simulator/simulate.hpp"

namespace cairn::cli {
namespace {

struct SimulateOptions {
  simulator::SimulationConfig simulation;
  LiveArguments live;
  std::vector<std::string> sensors;  // by name
  std::string motion = "gentle", screens = "none";
  bool json = false;
};

/// One line on a terminal that overwrites itself; nothing elsewhere.
simulator::Progress progress_line() {
  if (isatty(STDERR_FILENO) == 0) return {};
  return [shown = -1](double done) mutable {
    const int percent = static_cast<int>(std::floor(100.0 * done));
    if (percent == shown) return;
    shown = percent;
    std::fprintf(stderr, "\rsimulating %3d %%%s", percent, percent >= 100 ? "\n" : "");
  };
}

nlohmann::ordered_json to_json(const SimulateOptions& options, const std::vector<simulator::RobotSummary>& robots) {
  nlohmann::ordered_json object{{"scene", options.simulation.scene},
                                {"seconds", options.simulation.seconds},
                                {"seed", options.simulation.seed},
                                {"out", options.simulation.out.string()},
                                {"robots", nlohmann::ordered_json::array()}};
  for (const simulator::RobotSummary& r : robots) {
    object["robots"].push_back({{"name", r.name},
                                {"recording", (options.simulation.out / r.name).string()},
                                {"distance_m", r.distance_m},
                                {"data_packets", r.data_packets},
                                {"position_packets", r.position_packets},
                                {"shots", r.shots},
                                {"returns", r.returns},
                                {"camera_frames", r.camera_frames},
                                {"thermal_frames", r.thermal_frames},
                                {"depth_frames", r.depth_frames},
                                {"can_frames", r.can_frames},
                                {"line_events", r.line_events},
                                {"min_clearance_m", r.min_clearance_m}});
  }
  return object;
}

std::string in_words(const simulator::RobotSummary& r) {
  char text[96];
  std::snprintf(text, sizeof text, "%.1f m driven", r.distance_m);
  std::string words = text;
  if (r.data_packets > 0) {
    std::snprintf(text, sizeof text, ", %llu packets, %.1f %% of the shots returned",
                  static_cast<unsigned long long>(r.data_packets),
                  100.0 * static_cast<double>(r.returns) / static_cast<double>(r.shots));
    words += text;
  }
  const std::pair<std::uint64_t, const char*> counts[] = {{r.camera_frames, "camera frames"},
                                                          {r.thermal_frames, "thermal frames"},
                                                          {r.depth_frames, "depth frames"},
                                                          {r.can_frames, "CAN frames"},
                                                          {r.line_events, "line events"}};
  for (const auto& [count, what] : counts) {
    if (count > 0) words += ", " + std::to_string(count) + " " + what;
  }
  return words;
}

/// The names of --sensors as what they switch on; CLI11 has checked them.
simulator::Sensors sensors(const std::vector<std::string>& names) {
  simulator::Sensors s{.lidar = false};
  for (const std::string& name : names) {
    if (name == "all") return simulator::Sensors::all();
    s.lidar = s.lidar || name == "lidar";
    s.camera = s.camera || name == "camera";
    s.thermal = s.thermal || name == "thermal";
    s.depth = s.depth || name == "depth";
    s.drive = s.drive || name == "drive";
    s.gpio = s.gpio || name == "gpio";
  }
  return s;
}

/// What both kinds of simulation share.
int run_live(SimulateOptions options, bool limited) {
  simulator::LiveConfig& live = options.live.config;
  live.scene = options.simulation.scene;
  live.seed = options.simulation.seed;
  live.lidar = options.simulation.lidar;
  if (limited) live.seconds = options.simulation.seconds;
  return cli::run_live(options.live, options.json);
}

int run(SimulateOptions options, const CLI::App& sub) {
  if (options.simulation.flies()) make_uav(options.simulation);
  options.simulation.screens = simulator::screens_of(options.screens);
  options.simulation.motion = simulator::style_of(simulator::motion_of(options.motion));
  if (!options.sensors.empty()) options.simulation.sensors = sensors(options.sensors);
  if (const auto fit = check_unused_options(sub, options.simulation); !fit) return app::fail(fit.error());
  app::catch_stop_signals();
  options.simulation.stop = app::stop_requested;
  const auto robots = simulator::simulate(options.simulation, progress_line());
  if (!robots) return app::fail(robots.error());
  if (options.json) return app::print(to_json(options, *robots));
  for (const simulator::RobotSummary& r : *robots) {
    std::printf("%s: %s\n", (options.simulation.out / r.name).string().c_str(), in_words(r).c_str());
  }
  return app::kDone;
}

CLI::Validator robot_name() {
  return {[](const std::string& name) -> std::string {
            return simulator::is_robot_name(name) ? "" : "a name has 1 to 32 letters, digits, - and _";
          },
          "NAME"};
}

void add_world_options(CLI::App& sub, simulator::SimulationConfig& s) {
  sub.add_option("--people", s.people.count, "number of people who walk about and cross the robots' paths")
      ->check(CLI::Range(0, simulator::kMaxPeople))
      ->capture_default_str();
  sub.add_option("--people-pause", s.people.pause_s, "people stand for so long wherever they arrive, s")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  sub.add_flag("--night", s.night, "the sun is down and all lamps are off");
  sub.add_option("--profile", s.profile,
                 "husky drives; uav flies, with the camera and, if --sensors says so, a depth camera")
      ->check(CLI::IsMember({"husky", "uav"}))
      ->capture_default_str();
}

void add_screens_option(CLI::App& sub, std::string& screens) {
  sub.add_option("--screens", screens, "screens of clear glass, or fences, stand about on the open floor")
      ->check(CLI::IsMember(std::vector<std::string>(simulator::kScreens.begin(), simulator::kScreens.end())))
      ->capture_default_str();
}

void add_motion_option(CLI::App& sub, std::string& motion) {
  sub.add_option("--motion", motion,
                 "how a husky moves: gentle to 1.5 m/s and 60 deg/s, brisk to 2 m/s and 90 deg/s, aggressive to 3 m/s "
                 "and 120 deg/s with bumps and sudden stops, handheld: a walking person carries it")
      ->check(CLI::IsMember(std::vector<std::string>(simulator::kMotions.begin(), simulator::kMotions.end())))
      ->capture_default_str();
}

void add_lidar_options(CLI::App& sub, simulator::LidarConfig& lidar) {
  sub.add_option("--range-noise", lidar.range_noise_m, "standard deviation of LiDAR ranges, m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  sub.add_option("--dropout", lidar.dropout, "share of LiDAR returns lost at random")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  auto* pps = sub.add_flag("--pps", lidar.pps, "lock the LiDAR's clock to UTC; otherwise it runs freely");
  sub.add_option("--satellites", lidar.satellites_sigma_m,
                 "a satellite receiver at the LiDAR tells where the robot is: standard deviation of each coordinate, m")
      ->check(CLI::Range(0.01, 100.0))
      ->needs(pps);
}

void add_camera_options(CLI::App& sub, simulator::StereoConfig& camera, simulator::ThermalConfig& thermal) {
  sub.add_option("--camera-rate", camera.rate_hz,
                 "pictures of the camera a second, 1/s; the trigger's pulses with them")
      ->check(CLI::Range(0.01, 120.0))
      ->capture_default_str();
  sub.add_flag("--separate-eyes", camera.separate_eyes,
               "records the eyes as camera and camera_right, instead of side by side in one picture");
  sub.add_option("--camera-noise", camera.noise_factor, "factor on the noise of the camera's pictures")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  sub.add_option("--exposure", camera.exposure_stops,
                 "exposure of the camera in stops: 1 is twice the light that fits, -1 half of it")
      ->check(CLI::Range(-10.0, 10.0))
      ->capture_default_str();
  sub.add_option("--exposure-error", camera.exposure_error_stops,
                 "how far an automatic exposure wanders, one standard deviation, stops")
      ->check(CLI::Range(0.0, 4.0))
      ->capture_default_str();
  sub.add_option("--line-time", camera.line_time_s,
                 "rolling shutter: time from one row of a picture to the next, s; 0: all rows at once")
      ->check(CLI::Range(0.0, 1e-3))
      ->capture_default_str();
  sub.add_option("--thermal-rate", thermal.rate_hz, "pictures of the thermal camera a second, 1/s")
      ->check(CLI::Range(0.01, 120.0))
      ->capture_default_str();
}

}  // namespace

void add_simulate_command(app::Commands& commands) {
  CLI::App* sub = commands.app.add_subcommand(
      "simulate", "drives robots through a simulated world; writes recordings with ground truth");
  const auto options = std::make_shared<SimulateOptions>();
  simulator::SimulationConfig& s = options->simulation;
  sub->add_option("--scene", s.scene, "the world")->required()->check(CLI::IsMember(simulator::scene_names()));
  sub->add_option("--out", s.out, "new folder: gets one recording per robot, NAME_1, NAME_2, …");
  sub->add_option("--name", s.name, "robots and their folders are called NAME_1, NAME_2, …")
      ->check(robot_name())
      ->capture_default_str();
  sub->add_option("--robots", s.robots, "number of robots")
      ->check(CLI::Range(1, simulator::kMaxRobots))
      ->capture_default_str();
  sub->add_option("--seconds", s.seconds,
                  "length of the recordings, s; a live simulation without it goes on until Ctrl-C")
      ->check(CLI::Range(0.1, simulator::kMaxSeconds))
      ->capture_default_str();
  sub->add_option("--seed", s.seed, "seed of paths and noise; the same seed gives the same bytes")
      ->capture_default_str();
  add_world_options(*sub, s);
  add_screens_option(*sub, options->screens);
  add_motion_option(*sub, options->motion);
  sub->add_option("--sensors", options->sensors, "sensors to record, with commas; default: lidar, for a uav camera")
      ->delimiter(',')
      ->check(CLI::IsMember({"lidar", "camera", "thermal", "depth", "drive", "gpio", "all"}));
  sub->add_option("--threads", s.threads, "threads to use; the result does not depend on it")
      ->check(CLI::Range(1U, 256U))
      ->capture_default_str();
  add_lidar_options(*sub, s.lidar);
  add_camera_options(*sub, s.stereo, s.thermal);
  sub->add_flag("--json", options->json, "one JSON object on stdout");
  add_live_options(*sub, options->live);
  sub->callback([&commands, options, sub] {
    commands.job = [options, sub] {
      if (const auto fit = check_live_options(*sub, options->live.live); !fit) return app::fail(fit.error());
      return options->live.live ? run_live(*options, sub->count("--seconds") > 0) : run(*options, *sub);
    };
  });
}

}  // namespace cairn::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "tools/simulator/lidar/lidar.hpp"
#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/motion/flight.hpp"
#include "tools/simulator/people/crowd.hpp"
#include "tools/simulator/scenes/screens.hpp"
#include "tools/simulator/sensors/depth_sensor.hpp"
#include "tools/simulator/sensors/motor_bus.hpp"
#include "tools/simulator/sensors/stereo.hpp"
#include "tools/simulator/sensors/thermal_camera.hpp"

namespace cairn::simulator {

/// What a robot carries and what is recorded.
struct Sensors {
  bool lidar = true, camera = false, thermal = false, depth = false, drive = false, gpio = false;

  [[nodiscard]] static Sensors all() { return {true, true, true, true, true, true}; }
  /// A uav finds its way by the camera, and can carry little else.
  [[nodiscard]] bool can_fly() const { return camera && !lidar && !thermal && !drive && !gpio; }
};

struct SimulationConfig {
  std::string scene = "office";
  int robots = 1;
  double seconds = 60.0;
  std::uint64_t seed = 1;  ///< paths, noise, dropouts, clocks; the world itself does not depend on it
  std::filesystem::path out;
  std::string name = "robot";  ///< robots and their folders are called so, with _1, _2, … behind
  CrowdConfig people;          ///< who walk about; with none, nothing else changes
  Screens screens = Screens::kNone;
  bool night = false;             ///< the sun is down and all lamps are off
  std::string profile = "husky";  ///< or uav: it flies, with the camera and perhaps a depth camera
  Sensors sensors;
  unsigned threads = 1;  ///< changes nothing but the time it takes
  MotionStyle motion;    ///< of a husky
  FlightLimits flight;
  LidarConfig lidar;
  StereoConfig stereo;
  ThermalConfig thermal;
  DepthConfig depth;
  WheelConfig wheels;
  std::function<bool()> stop;  ///< asked after every packet: whether to give up; empty: never

  [[nodiscard]] bool flies() const { return profile == "uav"; }
  /// Whether the classes of the LiDAR's returns are written, too: with the camera or with people.
  [[nodiscard]] bool labelled() const { return people.count > 0 || sensors.camera; }
};

/// Turns the robots into quadrotors with the camera alone: below the middle and 30° down, as a depth camera would be.
void make_uav(SimulationConfig& config);

/// What one robot did.
struct RobotSummary {
  std::string name;
  double distance_m = 0;
  std::uint64_t data_packets = 0, position_packets = 0;
  std::uint64_t shots = 0, returns = 0;
  std::uint64_t camera_frames = 0, thermal_frames = 0, depth_frames = 0, can_frames = 0, line_events = 0;
  double min_clearance_m = 0;  ///< least distance of the robot's outline to an obstacle
};

/// Called now and then with the share of the work that is done, 0…1.
using Progress = std::function<void(double)>;

inline constexpr double kTruthResolution = 0.1;  ///< m, of world.ot
inline constexpr int kMaxRobots = 16, kMaxPeople = 50;
inline constexpr double kMaxSeconds = 3600.0;

/// Whether robots can be called so: 1 to 32 letters, digits, - and _.
[[nodiscard]] bool is_robot_name(std::string_view name);

/// Writes out/robot_1 … out/robot_N (SimulationConfig::name has another word for robot), each a recording with the
/// files of its sensors: recording.yaml, lidar.pcap, camera/, thermal/ and depth/ (data.csv and data/*.png), drive.log,
/// gpio.csv; profile.yaml, the profile that decodes them; and the truth:
///   ground_truth.tum   T_world_base at 100 Hz on the recording's time line
///   world.ot           see Voxels; without people
///   people.csv         with people; see Crowd::to_csv
///   labels/STAMP.png   trainIds of the left eye's pixels, one picture for each of the camera's
///   true_boxes.csv     with camera or thermal: who is on which picture, in the form of boxes.csv; see SeenPeople
///   lidar_labels.bin   with camera or people: 384 trainIds for each data packet, in the packet's order, 255 where
///                      nothing returned or what returned has no class
/// The bytes of a sensor do not depend on which others there are. The same config gives the same bytes, for any number
/// of threads and on every x86-64 with FMA and the same C library (whose sin and cos may differ in the last bit without
/// FMA).
///
/// Errors: kInvalidConfig for a scene, number or duration that cannot be, and for screens without room; kIo when `out`
/// exists and is not an empty folder, or when the disk refuses; kTruncated when `stop` ended it. `out` appears when all
/// of it is written: after an error there is nothing.
Result<std::vector<RobotSummary>> simulate(const SimulationConfig& config, const Progress& progress = {});

}  // namespace cairn::simulator

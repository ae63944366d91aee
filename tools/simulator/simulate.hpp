// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/simulator/drive.hpp"
#include "tools/simulator/lidar.hpp"

namespace cairn::simulator {

struct SimulationConfig {
  std::string scene = "office";
  int robots = 1;
  double seconds = 60.0;
  std::uint64_t seed = 1;  ///< paths, noise, dropouts, clocks; the world itself does not depend on it
  std::filesystem::path out;
  int people = 0;        ///< who walk about; with none, nothing else changes
  unsigned threads = 1;  ///< changes nothing but the time it takes
  DriveLimits drive;
  LidarConfig lidar;
};

/// What one robot did.
struct RobotSummary {
  std::string name;
  double distance_m = 0;
  std::uint64_t data_packets = 0, position_packets = 0;
  std::uint64_t shots = 0, returns = 0;
  double min_clearance_m = 0;  ///< least distance of the robot's outline to an obstacle
};

/// Called now and then with the share of the work that is done, 0…1.
using Progress = std::function<void(double)>;

inline constexpr double kTruthResolution = 0.1;  ///< m, of world.ot
inline constexpr int kMaxRobots = 16, kMaxPeople = 50;
inline constexpr double kMaxSeconds = 3600.0;

/// Writes out/robot_1 … out/robot_N, each a recording: recording.yaml, lidar.pcap, ground_truth.tum (T_world_base at
/// 100 Hz on the recording's time line), world.ot (see Voxels; without people) and, with people, people.csv. The same
/// config gives the same bytes, for any number of threads and on every x86-64 with FMA and the same C library (whose
/// sin and cos may differ in the last bit without FMA).
///
/// Errors: kInvalidConfig for a scene, number or duration that cannot be; kIo when `out` exists and is not an empty
/// folder, or when the disk refuses; then no half-made robot folder is left behind.
Result<std::vector<RobotSummary>> simulate(const SimulationConfig& config, const Progress& progress = {});

}  // namespace cairn::simulator

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/workers.hpp"
#include "tools/simulator/lidar_recorder.hpp"
#include "tools/simulator/stage.hpp"

namespace cairn::simulator {

/// One robot's sensors at work.
struct SensorRun {
  const Stage& stage;
  const Trajectory& trajectory;
  Time end;
  std::uint64_t seed;
  Workers& workers;
};
/// The truth about the picture taken at a time: the classes of the left eye's pixels, and who is on it.
using PictureTruth = std::function<Result<void>(Time, const std::vector<std::byte>&, const SeenPeople&)>;
using ThermalTruth = std::function<void(Time, const SeenPeople&)>;

/// Each hands all packets of one sensor to `sink`, in order, and returns how many there were.
Result<std::uint64_t> record_stereo(const SensorRun& run, const StereoConfig& config, const Sink& sink,
                                    const PictureTruth& truth, const Progress& progress);
Result<std::uint64_t> record_thermal(const SensorRun& run, const ThermalConfig& config, const Sink& sink,
                                     const ThermalTruth& truth);
Result<std::uint64_t> record_depth(const SensorRun& run, const DepthConfig& config, const Sink& sink);
/// CAN frames, both ways; the drive is armed once the e-stop allows it.
Result<std::uint64_t> record_motors(const SensorRun& run, const WheelConfig& config, const Sink& sink);
/// Events of the e-stop and of a trigger that rises `trigger_hz` times a second.
Result<std::uint64_t> record_lines(const SensorRun& run, double trigger_hz, const Sink& sink);

}  // namespace cairn::simulator

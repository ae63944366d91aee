// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hal/point_cloud.hpp"
#include "hal/time.hpp"
#include "onboard/robot.hpp"
#include "onboard/safety/failsafe.hpp"
#include "onboard/scheduler/channel.hpp"

namespace cairn {

/// A whole scan, and when its last byte was there.
struct ArrivedScan {
  Scan scan;
  Time arrival{};
};

/// A located scan, and when the last byte of the scan was there.
struct ArrivedMotion {
  LocatedScan scan;
  Time arrival{};
};

/// When each kind of sensor last gave something good, and what is wrong with what they give.
struct SensorsSeen {
  std::array<Seen, kWatched> seen{};
  FaultSet faults;
};

/// What odometry says of itself.
struct OdometryNews {
  bool lost = false;  ///< the last scan did not fit: the pose is only a prediction
};

/// What the drive says of itself.
struct DriveNews {
  DriveStatus status;
  Seen feedback;
};

using ScanChannel = scheduler::Channel<ArrivedScan>;
using MotionChannel = scheduler::Channel<ArrivedMotion>;
using SeenChannel = scheduler::Channel<SensorsSeen>;
using OdometryChannel = scheduler::Channel<OdometryNews>;
using DecisionChannel = scheduler::Channel<FailsafeDecision>;
using DriveChannel = scheduler::Channel<DriveNews>;

}  // namespace cairn

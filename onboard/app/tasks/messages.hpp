// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hal/point_cloud.hpp"
#include "hal/time.hpp"
#include "onboard/robot.hpp"
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

using ScanChannel = scheduler::Channel<ArrivedScan>;
using MotionChannel = scheduler::Channel<ArrivedMotion>;

}  // namespace cairn

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/se3.hpp"
#include "hal/time.hpp"

namespace cairn {

struct StampedPose {
  Time stamp{};
  SE3 pose;
};

}  // namespace cairn

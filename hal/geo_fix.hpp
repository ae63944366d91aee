// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/time.hpp"

namespace cairn {

/// Where a satellite receiver on the robot was (WGS 84).
struct GeoFix {
  Time stamp{};  ///< arrival: up to a second after the receiver was there
  double latitude_deg = 0, longitude_deg = 0;
};

}  // namespace cairn

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/image.hpp"

namespace cairn::stereo {

/// Both eyes at one instant, as the cameras of a StereoGeometry would see it: kMono8.
struct StereoPair {
  Time stamp{};
  Image left, right;
};

}  // namespace cairn::stereo

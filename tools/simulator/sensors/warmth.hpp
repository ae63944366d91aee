// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulator/sensors/climate.hpp"
#include "tools/simulator/sensors/view.hpp"

namespace cairn::simulator {

/// What a thermal camera takes the surface for, °C. Skin has 33.5 to 35.5 °C, clothes lie between it and the air, what
/// the sun shines on is up to 20 K warmer, walls keep the day's warmth into the night; metal and glass mirror the sky's
/// cold. Radiation adds up as T⁴ (Stefan and Boltzmann): emissivity · own + (1 − emissivity) · mirrored.
[[nodiscard]] double apparent_celsius(const Sighting& sighting, const Climate& climate, const Instant& instant);

}  // namespace cairn::simulator

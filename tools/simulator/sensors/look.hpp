// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulator/sensors/climate.hpp"
#include "tools/simulator/sensors/view.hpp"
#include "tools/simulator/world/material.hpp"

namespace cairn::simulator {

/// Smooth noise in [0, 1] with a lattice of one unit: random values at whole numbers, between them a cubic step.
[[nodiscard]] double value_noise(const Eigen::Vector3d& p);

/// Share of light that a surface throws back, with its pattern: bricks, slabs, boards, grass, mottled paint. The
/// pattern lies in the world (a Sighting's `pattern`). What is finer than `footprint` metres is left out, since a pixel
/// sees its mean.
[[nodiscard]] Rgb albedo(Material material, const Eigen::Vector3d& pattern, const Eigen::Vector3d& normal,
                         double footprint);

/// Light that a pixel gets, linear: diffuse surfaces, a mirror image of the sky in glass and varnish, the sky itself.
/// `pixel_rad` is the angle that a pixel covers.
[[nodiscard]] Rgb radiance(const Sighting& sighting, const Climate& climate, const Instant& instant, double pixel_rad);

}  // namespace cairn::simulator

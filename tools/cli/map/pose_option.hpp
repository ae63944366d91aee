// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/se3.hpp"

namespace cairn::cli {

/// The pose of an option such as --pose: x, y, z in metres, then roll, pitch, yaw in radians. Errors (kInvalidConfig,
/// which name `option`): other than six numbers, one that is not finite, an angle beyond ±2π, which was meant in
/// degrees, or a distance above 100 km.
[[nodiscard]] Result<SE3> pose_from_option(const std::string& option, const std::vector<double>& xyz_rpy);

/// The covariance of a pose, row by row, as `cairn match --json` prints it (m, rad, right perturbation). Zero where no
/// number is given. Errors (kInvalidConfig, which name `option`): other than 36 numbers, one that is not finite, a
/// matrix that is not symmetric or has a negative eigenvalue.
[[nodiscard]] Result<Matrix6> covariance_from_option(const std::string& option, const std::vector<double>& row_major);

}  // namespace cairn::cli

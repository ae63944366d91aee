// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/pose_option.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "hal/symmetric_eigen.hpp"

namespace cairn::cli {
namespace {

constexpr double kFullTurn_rad = 2 * std::numbers::pi;
constexpr double kFarthestPose_m = 1e5;
constexpr double kRounded = 1e-6;  // of the largest number: what printing may have changed
constexpr const char* kNames[] = {"x", "y", "z", "roll", "pitch", "yaw"};

Error refused(const std::string& option, std::string_view cause, std::string detail) {
  return {Errc::kInvalidConfig, cause, option, {}, std::move(detail)};
}

}  // namespace

Result<SE3> pose_from_option(const std::string& option, const std::vector<double>& xyz_rpy) {
  if (xyz_rpy.size() != 6) return refused(option, "a pose has six numbers", "x,y,z,roll,pitch,yaw in m and rad");
  for (std::size_t i = 0; i < 6; ++i) {
    const double value = xyz_rpy[i];
    if (!std::isfinite(value))
      return refused(option, "a pose has finite numbers", fmt::format("{} is {}", kNames[i], value));
    if (i < 3 && std::abs(value) > kFarthestPose_m)
      return refused(option, "maps lie within 100 km of each other", fmt::format("{} is {:.6g} m", kNames[i], value));
    if (i >= 3 && std::abs(value) > kFullTurn_rad)
      return refused(option, "angles are in radians, up to a full turn",
                     fmt::format("{} is {:.6g}; if that is in degrees, write {:.6g}", kNames[i], value,
                                 value * std::numbers::pi / 180));
  }
  return SE3::from_xyz_rpy(Eigen::Map<const Vector6>(xyz_rpy.data()));
}

Result<Matrix6> covariance_from_option(const std::string& option, const std::vector<double>& row_major) {
  if (row_major.empty()) return Matrix6(Matrix6::Zero());
  if (row_major.size() != 36) return refused(option, "a covariance has 36 numbers", "as cairn match --json prints it");
  const Matrix6 given = Eigen::Map<const Matrix6>(row_major.data());  // symmetric, so the order does not matter
  if (!given.allFinite()) return refused(option, "a covariance has finite numbers", "");
  const double scale = given.cwiseAbs().maxCoeff();
  if ((given - given.transpose()).cwiseAbs().maxCoeff() > kRounded * scale)
    return refused(option, "a covariance is symmetric", "give all numbers, in the order in which they were printed");
  const Matrix6 covariance = 0.5 * (given + given.transpose());
  if (symmetric_eigen(covariance).values[0] < -kRounded * scale)
    return refused(option, "a covariance has no negative eigenvalue", "give the numbers as they were printed");
  return covariance;
}

}  // namespace cairn::cli

// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/map/pose_option.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace cairn::cli {
namespace {

constexpr double kFullTurn_rad = 2 * std::numbers::pi;
constexpr double kFarthest_m = 1e5;
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
    if (i < 3 && std::abs(value) > kFarthest_m)
      return refused(option, "maps lie within 100 km of each other", fmt::format("{} is {:.6g} m", kNames[i], value));
    if (i >= 3 && std::abs(value) > kFullTurn_rad)
      return refused(option, "angles are in radians, up to a full turn",
                     fmt::format("{} is {:.6g}; if that is in degrees, write {:.6g}", kNames[i], value,
                                 value * std::numbers::pi / 180));
  }
  return SE3::from_xyz_rpy(Eigen::Map<const Vector6>(xyz_rpy.data()));
}

}  // namespace cairn::cli

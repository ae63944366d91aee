// SPDX-License-Identifier: Apache-2.0
#include "onboard/perception/stereo/depth_planes.hpp"

#include <cmath>

namespace cairn::stereo {
namespace {

// Of an RGB-D camera, 1 / depth has a noise of some 0.007 / m: 2 % at 3 m. DisparityField counts in pixels, and its
// first fit takes all within 1.2 pixels: 0.4 m at 4 m. With more, the ground behind somebody drew them backwards.
constexpr double kDepthPixels = 45;    // of a disparity at 1 m
constexpr double kDepthGate_px = 0.8;  // two and a half times the noise
constexpr int kFewestNeighbours = 12;  // of 81

}  // namespace

Eigen::Vector2i DepthPlanes::sample_of(const Eigen::Vector3f& point) const {
  const double x = static_cast<double>(point.x());
  const double u = grid_.cx - grid_.fx * static_cast<double>(point.y()) / x;
  const double v = grid_.cy - grid_.fy * static_cast<double>(point.z()) / x;
  return {static_cast<int>(std::lround(u / grid_.step_px)), static_cast<int>(std::lround(v / grid_.step_px))};
}

void DepthPlanes::smooth(std::vector<Eigen::Vector3f>& points) {
  const int columns = (grid_.width + grid_.step_px - 1) / grid_.step_px;
  const int rows = (grid_.height + grid_.step_px - 1) / grid_.step_px;
  field_.reset(columns, rows);
  std::erase_if(points, [&](const Eigen::Vector3f& p) {
    const Eigen::Vector2i at = sample_of(p);
    if (!((at.array() >= 0).all() && at.x() < columns && at.y() < rows)) return true;
    field_.set(at.x(), at.y(), kDepthPixels / static_cast<double>(p.x()));
    return false;
  });
  std::erase_if(points, [&](Eigen::Vector3f& p) {
    const Eigen::Vector2i at = sample_of(p);
    const auto disparity = field_.on_plane(at.x(), at.y(), kDepthGate_px, kFewestNeighbours);
    if (disparity) p *= static_cast<float>(kDepthPixels / *disparity) / p.x();
    return !disparity;
  });
}

}  // namespace cairn::stereo

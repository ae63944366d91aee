// SPDX-License-Identifier: Apache-2.0
#include "tests/support/stereo_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cairn::support {

double texture(const Eigen::Vector3d& p, double cell_m) {
  const auto corner = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    auto h = static_cast<std::uint64_t>(x * 73856093 ^ y * 19349663 ^ z * 83492791);
    h = (h ^ (h >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    return static_cast<double>((h ^ (h >> 27U)) >> 40U) / static_cast<double>(1U << 24U);
  };
  const Eigen::Vector3d q = p / cell_m;
  const Eigen::Vector3d low = q.array().floor();
  const Eigen::Vector3d t = q - low;
  const Eigen::Vector3d s = t.array().square() * (3 - 2 * t.array());
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = i >> 1 & 1, z = i >> 2 & 1;
    const double weight = (x ? s.x() : 1 - s.x()) * (y ? s.y() : 1 - s.y()) * (z ? s.z() : 1 - s.z());
    sum += weight * corner(static_cast<std::int64_t>(low.x()) + x, static_cast<std::int64_t>(low.y()) + y,
                           static_cast<std::int64_t>(low.z()) + z);
  }
  return sum;
}

void StereoView::expose(const std::function<SE3(double)>& T_world_eye_at, Image& image) {
  std::normal_distribution<double> noise(0, 1.3);
  image.resize(PixelFormat::kMono8, geometry_.width, geometry_.height);
  for (int v = 0; v < geometry_.height; ++v) {
    const SE3 T_world_eye = T_world_eye_at(geometry_.after_stamp_s(v));
    const Eigen::Matrix3d R = T_world_eye.rotation();
    for (int u = 0; u < geometry_.width; ++u) {
      const Eigen::Vector3d ray((u - geometry_.cx) / geometry_.fx, (v - geometry_.cy) / geometry_.fy, 1);
      const Eigen::Vector3d d = R * ray.normalized();
      const double range = world_.cast(T_world_eye.translation(), d);
      const Eigen::Vector3d p = T_world_eye.translation() + std::min(range, 1e3) * d;
      const double grey = 40 + 110 * texture(p, 0.25) + 70 * texture(p, 0.07) + noise(noise_);
      image.bytes[static_cast<std::size_t>(v) * image.stride + static_cast<std::size_t>(u)] =
          static_cast<std::byte>(std::clamp(std::lround(grey), 0L, 255L));
    }
  }
}

}  // namespace cairn::support

// SPDX-License-Identifier: Apache-2.0
#include "onboard/odometry/estimation/upright.hpp"

namespace cairn::odometry {
namespace {

// A block of one stray point is not occupied.
constexpr float kLeastPoints = 3;
// m. A floor that is tilted by 30° rises by 0.3 m within a column.
constexpr float kColumn_m = 0.5F;
// Bins of 0.3 m that another point of a wall or a trunk lies in: the second to the sixth, 0.3 to
// 2.1 m away. Rings of a VLP-16 are 0.7 m apart at 20 m (data sheet: 2°). The next bin may be the
// same floor, and a ceiling is higher.
constexpr std::uint64_t kNearAbove = 0b1111100;
constexpr std::uint64_t kNearBelow = std::uint64_t{0b0011111} << 57U;

}  // namespace

void UprightColumns::copy(const PatchMap& map, const Eigen::Vector3d& centre) {
  const double edge = map.finest().edge();
  per_metre_ = static_cast<float>(1 / edge);
  const Eigen::Array3i half(kWidth / 2, kWidth / 2, kHeight / 2);
  const Eigen::Array3i first = (centre / edge).array().floor().cast<int>() - half;
  offset_ = (centre / edge - first.matrix().cast<double>()).head<2>().cast<float>();
  blocks_.assign(static_cast<std::size_t>(kWidth) * kWidth * kHeight, 0);
  map.finest().for_each_block([&](const BlockIndex& at, const Moments& m) {
    const Eigen::Array3i k = Eigen::Array3i(at.x, at.y, at.z) - first;
    if (m.count < kLeastPoints || (k < 0).any() || (k >= 2 * half).any()) return;
    blocks_[static_cast<std::size_t>((k.x() * kWidth + k.y()) * kHeight + k.z())] = 1;
  });
  columns_.assign(static_cast<std::size_t>(kWidth) * kWidth, 0);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const std::uint8_t* column = &blocks_[c * kHeight];
    for (int z = 1; z < kHeight; ++z) columns_[c] |= static_cast<std::uint8_t>(column[z - 1] & column[z]);
  }
}

int UprightColumns::count(std::span<const Eigen::Vector2f> points, float dx, float dy) const {
  const float ox = offset_.x() + per_metre_ * dx, oy = offset_.y() + per_metre_ * dy;
  int sum = 0;
  for (const Eigen::Vector2f& p : points) {
    // A point far outside gives a float that no int holds: the comparison comes first.
    const float x = per_metre_ * p.x() + ox, y = per_metre_ * p.y() + oy;
    if (!(x >= 0 && y >= 0 && x < kWidth && y < kWidth)) continue;
    sum += columns_[static_cast<std::size_t>(static_cast<int>(x) * kWidth + static_cast<int>(y))];
  }
  return sum;
}

std::optional<std::size_t> UprightPoints::column(const Eigen::Vector3f& p) {
  const float x = p.x() / kColumn_m + kWidth / 2.0F, y = p.y() / kColumn_m + kWidth / 2.0F;
  if (!(x >= 0 && y >= 0 && x < kWidth && y < kWidth)) return std::nullopt;
  return static_cast<std::size_t>(static_cast<int>(x) * kWidth + static_cast<int>(y));
}

std::optional<int> UprightPoints::bin(const Eigen::Vector3f& p) {
  const float z = p.z() / kBin_m + kBins / 2.0F;
  if (!(z >= 0 && z < kBins)) return std::nullopt;
  return static_cast<int>(z);
}

/// Another point of its column lies above or below, nearer than a ceiling.
bool UprightPoints::stands(const Eigen::Vector3f& p) const {
  const auto c = column(p);
  const auto z = bin(p);
  if (!c || !z) return false;
  const std::uint64_t above = filled_[*c] >> *z, below = filled_[*c] << (kBins - 1 - *z);
  return ((above & kNearAbove) | (below & kNearBelow)) != 0;
}

void UprightPoints::choose(std::span<const Keypoint> scan, const SE3& T_odom_lidar, std::size_t wanted,
                           std::vector<Keypoint>& out) {
  const Eigen::Matrix3f R = T_odom_lidar.rotation().cast<float>();
  filled_.assign(static_cast<std::size_t>(kWidth) * kWidth, 0);
  for (const Keypoint& k : scan) {
    const Eigen::Vector3f p = R * k.p_lidar;
    const auto c = column(p);
    const auto z = bin(p);
    if (c && z) filled_[*c] |= std::uint64_t{1} << *z;
  }
  upright_.clear();
  for (const Keypoint& k : scan)
    if (stands(R * k.p_lidar)) upright_.push_back(k);
  const std::size_t stride = upright_.size() / wanted + 1;
  out.clear();
  for (std::size_t i = 0; i < upright_.size(); i += stride) out.push_back(upright_[i]);
}

}  // namespace cairn::odometry

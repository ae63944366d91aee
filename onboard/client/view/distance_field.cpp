// SPDX-License-Identifier: Apache-2.0
#include "onboard/client/view/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn::client {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// One pass of the transform along an axis: squared distances in cells, for lines of any stride.
class LinePass {
 public:
  explicit LinePass(int longest)
      : values_(static_cast<std::size_t>(longest)),
        vertex_(static_cast<std::size_t>(longest)),
        from_(static_cast<std::size_t>(longest) + 1) {}

  void run(float* line, std::size_t stride, int count) {
    int parabolas = 0;
    for (int i = 0; i < count; ++i) {
      values_[static_cast<std::size_t>(i)] = line[static_cast<std::size_t>(i) * stride];
      if (values_[static_cast<std::size_t>(i)] != kFar) parabolas = add(i, parabolas);
    }
    if (parabolas == 0) return;  // nothing is marked: all stays far
    int k = 0;
    for (int i = 0; i < count; ++i) {
      while (k + 1 < parabolas && from_[static_cast<std::size_t>(k) + 1] < static_cast<double>(i)) ++k;
      const int v = vertex_[static_cast<std::size_t>(k)];
      line[static_cast<std::size_t>(i) * stride] =
          static_cast<float>((i - v) * (i - v)) + values_[static_cast<std::size_t>(v)];
    }
  }

 private:
  [[nodiscard]] double meeting(int a, int b) const {
    const auto height = [this](int i) {
      return static_cast<double>(values_[static_cast<std::size_t>(i)]) + double{1} * i * i;
    };
    return (height(b) - height(a)) / (2.0 * (b - a));
  }
  /// Adds the parabola at `i` to the lower envelope, and returns how many are in it.
  int add(int i, int parabolas) {
    double from = -std::numeric_limits<double>::infinity();
    while (parabolas > 0) {
      from = meeting(vertex_[static_cast<std::size_t>(parabolas) - 1], i);
      if (from > from_[static_cast<std::size_t>(parabolas) - 1]) break;
      --parabolas;
      from = -std::numeric_limits<double>::infinity();
    }
    vertex_[static_cast<std::size_t>(parabolas)] = i;
    from_[static_cast<std::size_t>(parabolas)] = from;
    return parabolas + 1;
  }

  std::vector<float> values_;
  std::vector<int> vertex_;
  std::vector<double> from_;  // where each parabola begins to be the lowest
};

/// Marked cells are 0, all others far; gives distances in metres.
void transform(std::vector<float>& field, const Eigen::Vector3i& size, double cell_m) {
  LinePass pass(size.maxCoeff());
  const auto x = static_cast<std::size_t>(size.x()), y = static_cast<std::size_t>(size.y()),
             z = static_cast<std::size_t>(size.z());
  for (std::size_t line = 0; line < y * z; ++line) pass.run(field.data() + line * x, 1, size.x());
  for (std::size_t k = 0; k < z; ++k)
    for (std::size_t i = 0; i < x; ++i) pass.run(field.data() + k * x * y + i, x, size.y());
  if (z > 1)
    for (std::size_t line = 0; line < x * y; ++line) pass.run(field.data() + line, x * y, size.z());
  for (float& value : field) value = static_cast<float>(cell_m * std::sqrt(static_cast<double>(value)));
}

}  // namespace

std::vector<float> distances_2d(std::span<const std::uint8_t> marked, int width, int height, double cell_m) {
  std::vector<float> field(marked.size());
  std::ranges::transform(marked, field.begin(), [](std::uint8_t m) { return m != 0 ? 0.0F : kFar; });
  transform(field, {width, height, 1}, cell_m);
  return field;
}

DistanceField make_distance_field(const PlannerView& view, const SE3& T_odom_base,
                                  const DistanceField::Extent& extent) {
  DistanceField field;
  field.resolution_m = view.resolution_m();
  constexpr double kMostSide = 500, kMostUp = 64;
  const auto voxels = [&](double length_m, double most) {
    return static_cast<int>(std::clamp(std::ceil(length_m / field.resolution_m), 1.0, most));
  };
  const int side = voxels(2 * extent.side_m, kMostSide);
  field.size = {side, side, voxels(extent.up_m + extent.down_m, kMostUp)};
  const Eigen::Vector3d lowest =
      T_odom_base.translation() - Eigen::Vector3d(extent.side_m, extent.side_m, extent.down_m);
  field.corner = (lowest / field.resolution_m).array().floor().matrix() * field.resolution_m;
  field.distance_m.assign(static_cast<std::size_t>(field.size.prod()), kFar);
  std::size_t i = 0;
  for (int z = 0; z < field.size.z(); ++z)
    for (int y = 0; y < field.size.y(); ++y)
      for (int x = 0; x < field.size.x(); ++x, ++i) {
        const Eigen::Vector3d centre = field.corner + field.resolution_m * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
        if (view.occupancy(centre) == Occupancy::kOccupied) field.distance_m[i] = 0;
      }
  transform(field.distance_m, field.size, field.resolution_m);
  return field;
}

float DistanceField::at(const Eigen::Vector3d& p_odom) const {
  const Eigen::Vector3d cell = ((p_odom - corner) / resolution_m).array().floor();
  if (!cell.allFinite() || (cell.array() < 0).any() || (cell.array() >= size.cast<double>().array()).any()) return kFar;
  const Eigen::Vector3i at = cell.cast<int>();
  return distance_m[static_cast<std::size_t>(at.x() + size.x() * (at.y() + size.y() * at.z()))];
}

}  // namespace cairn::client

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// Poses around an initial one: moved by up to so much along x, y and z of the target's frame, and turned about the
/// source's own z axis.
struct SearchWindow {
  double xy_m = 2.4, z_m = 0, yaw_rad = 0.32;  ///< half widths
  double yaw_step_rad = 0.026;                 ///< 1.5°
};

/// A local maximum of the coarse score.
struct Mode {
  SE3 T_target_source;
  double score;  ///< mean of the field over the source's points, 0…1
};

/// exp(−d²/2σ²) of the distance d to the nearest point, sampled in cubic cells: how likely a surface is to be seen
/// there. The cells grow, if they must, until the field fits into memory, whatever the map claims.
class LikelihoodField {
 public:
  static constexpr double kMaxCells = 2e7;

  /// With a margin that a shift of the window never leaves.
  LikelihoodField(std::span<const Eigen::Vector3f> points, float cell_m, const SearchWindow& window);

  [[nodiscard]] float cell_m() const { return cell_m_; }
  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] const Eigen::Vector3i& margin() const { return margin_; }
  /// Cell of a point of the target's frame, counted from the field's corner.
  [[nodiscard]] Eigen::Vector3i cell(const Eigen::Vector3f& point) const {
    return (point / cell_m_).array().floor().cast<int>().matrix() - first_;
  }
  /// The values from this cell on along x.
  [[nodiscard]] const float* row(int x, int y, int z) const { return values_.data() + index(x, y, z); }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(x);
  }
  void lay_out(std::span<const Eigen::Vector3f> points, const SearchWindow& window);
  void splat(const Eigen::Vector3f& point);

  float cell_m_;
  Eigen::Vector3i first_, size_, margin_;
  std::vector<float> values_;  // squared distances in cells while it is made
};

/// The `modes` best poses of the window that are more than 0.8 m or 4° apart, best first. Exhaustive (Olson's
/// correlative scan matching in three dimensions): for each heading the points' rows of cells are added up, which
/// gives all shifts at once. `points`: a few thousand of the source's, m. At least one mode, for any input.
[[nodiscard]] std::vector<Mode> search(const LikelihoodField& field, std::span<const Eigen::Vector3f> points,
                                       const SE3& initial, const SearchWindow& window, int modes);

}  // namespace cairn::matching

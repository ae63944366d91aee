// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fusion/matching/features/surfel_grid.hpp"
#include "hal/se3.hpp"

namespace cairn::matching {

/// The poses around an initial one that a search covers: moved along x, y and z of the target's
/// frame, and turned about the source's z axis. PriorModes makes it from a prior.
struct SearchWindow {
  /// Half width along x and along y, m: the protocol's 2 m and a fifth more.
  double xy_m = 2.4;
  double z_m = 0;         ///< half width along z, m; 0: the height is known
  double yaw_rad = 0.32;  ///< half width of the heading, rad: the protocol's 15° and a fifth more
  /// Step of the heading, rad: 1.5°, which moves a point 10 m away by less than a cell.
  double yaw_step_rad = 0.026;
};

/// A local maximum of the coarse score.
struct Mode {
  SE3 T_target_source;
  double score;  ///< mean of the field over the source's points, 0…1
};

/// How likely a surface is seen at a place: exp(−d²/2σ²) of the distance d to the nearest point,
/// with σ of one cell. It is sampled in cubic cells. The cells grow until the field fits into
/// memory.
class LikelihoodField {
 public:
  /// Cells of the field, at most: 80 MB. A bound on memory, whatever the map claims.
  static constexpr double kMaxCells = 2e7;

  /// `points` of the target, `cell_m` in m. The margin is so wide that no shift of the window
  /// leaves it.
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

/// The `modes` best poses of the window that are different places (see same_place()), best first.
/// The search is exhaustive: Olson's correlative scan matching (ICRA 2009), in three dimensions.
/// For each heading, the points' rows of cells are added up, which gives all shifts at once.
/// `points`: a few thousand of the source's, m. Gives at least one mode, for any input.
[[nodiscard]] std::vector<Mode> search(const LikelihoodField& field, std::span<const Eigen::Vector3f> points,
                                       const SE3& initial, const SearchWindow& window, int modes);

}  // namespace cairn::matching

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace cairn::stereo {

/// Disparities on a grid of samples of the left picture, each of which is noisy, and the planes that they lie on.
///
/// In a picture, the disparity of a plane changes evenly with the column and the row. So the samples around one that
/// lie on the same plane say what its disparity is, and with less noise. One that hardly any of its neighbours agree
/// with is a wrong match.
class DisparityField {
 public:
  /// Samples to each side that count. Of car parks, 3 left 20 % more noise, and 5 left 20 % less structure.
  static constexpr int kReach = 4;

  /// Samples that do not exist yet, in `columns` and `rows`.
  void reset(int columns, int rows);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }

  /// Pixels.
  void set(int column, int row, double disparity) { values_[index(column, row)] = static_cast<float>(disparity); }

  /// Disparity in pixels of the plane through a sample and its neighbours (weighted least squares). A neighbour that is
  /// e pixels off the plane has the weight 1 − (e / gate_px)²; farther than the gate, it is of something else. None
  /// where the sample has no disparity, or where the weights, its own included, add up to less than `least`.
  [[nodiscard]] std::optional<double> on_plane(int column, int row, double gate_px, int least) const;

 private:
  static constexpr float kNothing = -1e9F;  // far from every plane
  struct Plane;
  struct Sums;
  [[nodiscard]] Sums sum(int column, int row, const Plane& plane, float gate) const;
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row + kReach) * stride_ + static_cast<std::size_t>(column + kReach);
  }

  int columns_ = 0, rows_ = 0;
  std::size_t stride_ = 0;     // of a row, with what is around the samples
  std::vector<float> values_;  // with an edge of nothing around it, so that no sum asks for its bounds
};

}  // namespace cairn::stereo

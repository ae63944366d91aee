// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hal/image.hpp"
#include "onboard/perception/alignment/depth_edges.hpp"

namespace cairn::alignment {

/// The strongest edges of a picture, and how far each pixel is from the nearest one.
class PictureEdges {
 public:
  static constexpr float kFar = 20;       ///< px; distances are cut off here
  static constexpr double kShare = 0.03;  ///< of the pixels are edges, of each kind

  /// `picture`: kMono8 or kBgr8. Replaces what was computed before. Reuses memory.
  void compute(const ImageView& picture);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Distance to the nearest edge of this kind, px, interpolated between pixels, whose centres are at whole numbers.
  /// kFar outside of the outermost centres.
  [[nodiscard]] float distance(EdgeKind kind, const Eigen::Vector2d& pixel) const;

 private:
  void take_grey(const ImageView& picture);
  void blur();
  void find_edges();
  void keep_strongest(std::vector<float>& strength) const;
  void spread(std::vector<float>& strength) const;
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_ = 0, height_ = 0;
  std::vector<float> grey_, scratch_;
  std::vector<float> upright_, level_;  // first the strength of edges, then distances
};

}  // namespace cairn::alignment

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>
#include <optional>

namespace cairn::stereo {

/// Where a search has left a pixel, and how its disparity changes around it.
struct DisparityStart {
  int x = 0, y = 0;                 ///< left pixel
  double disparity = 0;             ///< pixels
  double slope_x = 0, slope_y = 0;  ///< pixels of disparity per pixel
};

/// Makes disparities exact to a tenth of a pixel: Gauss–Newton steps on the difference of a patch in both eyes (Lucas,
/// Kanade, 1981, in one direction). The patch leans as the surface does. The left eye's gradient serves all steps, as
/// both patches look alike (Baker, Matthews, 2004). Both pictures: 8 bits, of the same size.
class DisparityRefiner {
 public:
  DisparityRefiner(const cv::Mat& left, const cv::Mat& right) : left_(left), right_(right) {}

  /// None where the patch has no structure, leaves the picture, does not look alike in both eyes, or moves by more than
  /// a pixel.
  [[nodiscard]] std::optional<double> refine(const DisparityStart& start) const;

  static constexpr int kReach = 3;  ///< pixels of a patch around its middle

 private:
  struct Patch;
  struct Sums;
  [[nodiscard]] Patch patch_at(const DisparityStart& start) const;
  [[nodiscard]] bool compare(const Patch& patch, const DisparityStart& start, float disparity, Sums& sums) const;

  const cv::Mat& left_;
  const cv::Mat& right_;
};

}  // namespace cairn::stereo

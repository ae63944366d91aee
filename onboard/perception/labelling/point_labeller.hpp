// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "hal/result.hpp"
#include "onboard/perception/labelling/labelling_config.hpp"
#include "onboard/perception/labelling/located_scans.hpp"
#include "onboard/perception/labelling/occlusion.hpp"
#include "onboard/perception/labelling/projection.hpp"

namespace cairn::labelling {

/// What became of the points of one scan.
struct LabellingFigures {
  std::size_t seen = 0;        ///< points in the picture and near enough
  std::size_t hidden = 0;      ///< of those: behind others
  std::size_t at_border = 0;   ///< of those: next to another class
  std::size_t unlabelled = 0;  ///< of those: sky, or no class, or a weight of zero
  std::size_t labelled = 0;    ///< of those: the rest, in the output
};

/// Labels of a picture → labels of the points that the camera saw. Pure; allocates nothing once it has seen its largest
/// scan. A point's label does not depend on the order of the points.
class PointLabeller {
 public:
  /// `camera`: of the camera's picture; label images may be smaller. `T_base_camera`: the mount, in body axes.
  PointLabeller(const cameras::CameraModel& camera, const SE3& T_base_camera, const LabellingConfig& config);

  /// Replaces `out` by the labelled points of the scan, in its order, at their places in odom. `scan` is best the one
  /// nearest to the exposure. Error kMalformed: the image's arrays do not have its size.
  Result<LabellingFigures> label(const LabelImage& labels, const PlacedScan& scan, const Exposure& exposure,
                                 std::vector<LabelledPoint>& out);

 private:
  [[nodiscard]] std::size_t label_of(const LabelImage& labels, const Projected& p) const;
  [[nodiscard]] bool at_border(const LabelImage& labels, const Projected& p) const;

  LabellingConfig config_;
  Projection projection_;
  Occlusion occlusion_;
};

}  // namespace cairn::labelling

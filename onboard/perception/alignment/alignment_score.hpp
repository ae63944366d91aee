// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hal/se3.hpp"
#include "onboard/perception/alignment/depth_edges.hpp"
#include "onboard/perception/alignment/picture_edges.hpp"
#include "onboard/perception/cameras/camera_model.hpp"

namespace cairn::alignment {

/// How well edges of scans meet edges of pictures, for one mount of the camera.
struct EdgeDistance {
  std::string_view mount;  ///< `as given`, or how it was turned
  double median_px = 0;    ///< distance of an edge of the scan to the nearest edge of the picture of its kind
  double within_2px = 0;   ///< share of the edges, 0 … 1
  double closeness = 0;    ///< mean of exp(−(distance / 2 px)²), 0 … 1: decides which mount fits best
};

/// A health figure of a camera's mount and intrinsics: the mount as it is given has to fit better than mounts that are
/// turned by half a degree. Chance alone gives some distance, so that only the comparison says something.
class AlignmentScore {
 public:
  static constexpr double kTurn_deg = 0.5;   ///< of the turned mounts
  static constexpr std::size_t kMounts = 7;  ///< as given, then roll, pitch and yaw, each by + and −

  AlignmentScore(const cameras::CameraModel& camera, const SE3& T_base_camera);

  /// Compares a picture with the edges of a scan. `T_scan_exposure`: base_link at the exposure in base_link at the
  /// scan's stamp. Only edges count that all mounts see.
  void add(const PictureEdges& picture, std::span<const DepthEdge> edges, const SE3& T_scan_exposure);

  [[nodiscard]] std::size_t pictures() const { return pictures_; }
  [[nodiscard]] std::size_t edges() const { return edges_; }
  /// The mount as given first.
  [[nodiscard]] std::array<EdgeDistance, kMounts> distances() const;
  /// Whether the mount as given has the largest closeness. Means nothing with less than kLeastEdges.
  [[nodiscard]] bool given_mount_is_best() const;
  static constexpr std::size_t kLeastEdges = 200;

 private:
  static constexpr int kBins = 200;  // of PictureEdges::kFar
  using Histogram = std::array<std::size_t, kBins + 1>;

  /// Of the nearest picture edge to where the rim of the thing may be; none: it is not seen.
  [[nodiscard]] std::optional<float> distance(const PictureEdges& picture, const DepthEdge& edge, std::size_t mount,
                                              const SE3& T_exposure_scan) const;

  cameras::CameraModel camera_;
  std::array<SE3, kMounts> T_optical_base_;
  std::array<Histogram, kMounts> histograms_{};
  std::size_t pictures_ = 0, edges_ = 0;
};

}  // namespace cairn::alignment

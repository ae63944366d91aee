// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/image.hpp"

namespace cairn::mount {

/// One place in two pictures, pixels as in CameraParameters.
struct Match {
  Eigen::Vector2d before = Eigen::Vector2d::Zero(), now = Eigen::Vector2d::Zero();
};

/// Settings of PictureTracker.
struct TrackerConfig {
  int corners = 200;          ///< at most, in a picture
  int spacing_px = 16;        ///< pixels between two corners, at least
  double quality = 0.003;     ///< of a corner: its response, as a share of the strongest one's
  int window_px = 15;         ///< edge of the patch that is compared, pixels
  int levels = 3;             ///< of the pyramid above the picture itself
  double most_back_px = 0.5;  ///< a corner that is followed forth and back again ends so near to where it began
};

/// Corners of one picture, found again in a later one: pyramids of Lucas and Kanade (Bouguet, 2001), by OpenCV. The
/// result does not depend on the number of threads.
class PictureTracker {
 public:
  explicit PictureTracker(const TrackerConfig& config = {});
  PictureTracker(PictureTracker&&) noexcept;
  PictureTracker& operator=(PictureTracker&&) noexcept;
  PictureTracker(const PictureTracker&) = delete;
  PictureTracker& operator=(const PictureTracker&) = delete;
  ~PictureTracker();

  /// Where a pixel of the reference is expected in the new picture; none: it is out of view.
  using Expected = std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d& before)>;

  /// Makes `picture` (kMono8 or kBgr8) the reference, and looks for its corners.
  void refer_to(const Image& picture);
  /// The corners of the reference in `picture`, which has the reference's size. Valid until the next call.
  [[nodiscard]] std::span<const Match> find_in(const Image& picture, const Expected& expected);
  /// Makes the picture of the last find_in() the reference.
  void refer_to_found();

  [[nodiscard]] std::size_t corners() const;

 private:
  struct Pictures;
  void look_for_corners();

  TrackerConfig config_;
  std::unique_ptr<Pictures> pictures_;
  std::vector<Match> matches_;
};

}  // namespace cairn::mount

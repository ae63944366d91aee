// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "onboard/perception/cameras/camera_model.hpp"
#include "onboard/perception/labelling/labelling_config.hpp"
#include "onboard/perception/labelling/projection.hpp"

namespace cairn::labelling {

/// Which points of a scan the camera does not see, because others are before them; see
/// LabellingConfig::occlusion_window_px. Allocates nothing after its construction.
class Occlusion {
 public:
  Occlusion(const cameras::CameraModel& camera, const LabellingConfig& config);

  /// Notes a point. `class_id`: what it is, or kNoClass.
  void add(const Projected& p, std::uint8_t class_id = kNoClass);
  /// Whether a noted point hides this one. `class_id`: of what stands upright, a point of the same class close above or
  /// below is enough.
  [[nodiscard]] bool hidden(const Projected& p, std::uint8_t class_id = kNoClass) const;
  /// Forgets the noted points, which were these.
  void clear(std::span<const Projected> noted);

 private:
  /// The nearest thing around a pixel, and its label.
  struct Nearest {
    float depth;
    std::uint8_t class_id;
  };
  [[nodiscard]] std::size_t pixel_of(const Projected& p) const;

  double farther_m_, farther_share_;
  int width_, height_;            // of the picture
  int window_;                    // pixels to each side
  int between_;                   // pixels above and below, for gaps between lasers
  int rim_;                       // the larger of both: what nearest_ has around the picture
  std::vector<Nearest> nearest_;  // in the window's columns around each pixel; infinitely far between two scans
};

}  // namespace cairn::labelling

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/packet.hpp"
#include "hal/semantic_class.hpp"
#include "hal/time.hpp"

namespace cairn {

/// What a picture shows, pixel by pixel, row by row from the upper left corner. It may be smaller than the picture;
/// then each of its pixels stands for an equal rectangle of the picture.
struct LabelImage {
  SourceId source{};                        ///< the camera
  Time stamp{};                             ///< of the picture: the exposure
  int width = 0, height = 0;                ///< pixels
  std::vector<std::uint8_t> classes;        ///< trainIds, or kNoClass
  std::vector<std::uint8_t> probabilities;  ///< of that class, in 255ths

  /// Makes room; the content is then undefined.
  void resize(int w, int h) {
    width = w;
    height = h;
    classes.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
    probabilities.resize(classes.size());
  }
  /// Of the pixel in both arrays.
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// One thing that a detector saw: a rectangle in pixels of the picture, clipped to it.
struct Detection {
  float x = 0, y = 0, width = 0, height = 0;  ///< upper left corner and size
  std::uint8_t class_id = kPersonClass;       ///< trainId
  float score = 0;                            ///< 0…1, as the network says
};

/// All that was detected in one picture.
struct Detections {
  SourceId source{};          ///< the camera
  Time stamp{};               ///< of the picture
  int width = 0, height = 0;  ///< of the picture, pixels
  std::vector<Detection> found;
};

/// A point of a scan whose class a picture told.
struct LabelledPoint {
  Eigen::Vector3f point_odom;    ///< metres
  std::uint8_t class_id = 0;     ///< trainId, below 19
  std::uint8_t probability = 0;  ///< of that class, in 255ths
  std::uint8_t weight = 0;       ///< how much the observation counts, in 255ths: less if far, grazing or movable
};

}  // namespace cairn

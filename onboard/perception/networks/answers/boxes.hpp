// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "onboard/perception/networks/config/class_map.hpp"
#include "onboard/perception/networks/model/network.hpp"

namespace cairn::networks {

/// A box in pixels of the network's input, before it is asked whether it is worth keeping.
struct Candidate {
  float left = 0, top = 0, right = 0, bottom = 0;
  std::size_t channel = 0;  ///< of the output: the class
  float score = 0;
};

/// Which boxes are kept.
struct BoxRules {
  float score_threshold = 0.3F;
  float nms_threshold = 0.45F;  ///< intersection over union
};
inline constexpr std::size_t kMaxCandidates = 1000;  ///< the best ones; the others are dropped
inline constexpr std::size_t kMaxBoxes = 100;        ///< of one picture, the best ones

/// How many rows the grids of these strides have for an input of this size.
[[nodiscard]] std::size_t yolox_rows(int width, int height, std::span<const int> strides);

/// Rows of YOLOX, one for each cell of each grid: x, y (offset from the cell's corner), width, height (logarithm), all
/// in strides, then the score of there being something, then the score of each class. Appends those above the
/// threshold. `rows` holds yolox_rows() × `columns` numbers.
void read_yolox(std::span<const float> rows, std::size_t columns, int width, int height, std::span<const int> strides,
                float threshold, std::vector<Candidate>& candidates);

/// Rows of an SSD's DetectionOutput: picture, class, score, left, top, right, bottom; coordinates are shares of the
/// input.
void read_ssd_rows(std::span<const float> rows, int width, int height, float threshold,
                   std::vector<Candidate>& candidates);
/// An SSD with two outputs: `scores` with one column per class, of which the first is the background, and `boxes` with
/// left, top, right, bottom as shares of the input.
void read_ssd_pair(std::span<const float> scores, std::size_t columns, std::span<const float> boxes, int width,
                   int height, float threshold, std::vector<Candidate>& candidates);

/// Candidates → detections in pixels of the picture: without classes that have no trainId, clipped, the weaker of
/// overlapping boxes of one class dropped, best first. Of equal scores the earlier candidate counts as better.
void select_boxes(std::vector<Candidate>& candidates, const ClassMap& classes, const BoxRules& rules,
                  const Placement& placement, std::vector<Detection>& found);

}  // namespace cairn::networks

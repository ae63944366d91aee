// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "hal/labels.hpp"
#include "tools/simulator/sensors/view.hpp"

namespace cairn::simulator {

/// How much of a person has to be seen to count: what no detector could find is no truth for one.
struct LeastSeen {
  int pixels = 25;
  double share = 0.15;  ///< of the pixels that the person would cover alone
};

/// Who can be seen on a picture, and how much of them. The rows of a picture are added in any order.
class SeenPeople {
 public:
  /// Begins a picture of `height` rows. `people`: size of the crowd.
  void begin(std::size_t people, int height);
  /// What row 0 <= `row` < height shows. `seen`: by look(), from `eye`; `figures`: the people at the row's exposure.
  /// Threads may add different rows at the same time.
  void add_row(int row, const Eigen::Vector3d& eye, std::span<const Sighting> seen, std::span<const Figure> figures);

  /// A box around the visible pixels of everybody of whom enough is seen, in the order of the crowd. The score is the
  /// visible share: pixels seen over pixels that the person would cover alone on this picture, 0…1.
  [[nodiscard]] std::vector<Detection> boxes(const LeastSeen& least) const;

 private:
  struct Part {  // of one person in one row
    int seen = 0, alone = 0;
    int left = 0, right = -1;  // of the pixels seen; the last one is in it
  };
  [[nodiscard]] Detection box(std::size_t person, const LeastSeen& least) const;

  std::size_t people_ = 0;
  std::vector<Part> parts_;  // row by row
};

}  // namespace cairn::simulator

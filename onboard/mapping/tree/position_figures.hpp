// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace cairn::mapping {

/// How far occupied voxels of a fused map are from where they are said to be: root mean squares, m.
struct PositionFigures {
  std::size_t voxels = 0;        ///< occupied
  std::size_t shared = 0;        ///< of these, known to several maps
  double mean_m = 0, p95_m = 0;  ///< of all; 0 where there is none
  double shared_mean_m = 0;      ///< of the shared ones
  double shared_alone_m = 0;     ///< of the shared ones, by the map that knows each best, taken alone
};

}  // namespace cairn::mapping

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "fusion/matching/search/refine.hpp"

namespace cairn::matching {

/// RefineOptions with lengths in cells of the surfels that are refined on, for maps of any voxel
/// size.
struct RefinementStage {
  float gate_cells = 0;       ///< largest distance of a pair in the first iteration
  float last_gate_cells = 0;  ///< the gate shrinks to this
  float gate_decay = 1;       ///< by this factor in each iteration
  int max_iterations = 0;
  /// Pairs this far apart along their normals count 1/4; 0: all count 1.
  float robust_cells = 0;
  double stop_m = 0, stop_rad = 0;  ///< ends at a smaller step, once the gate has shrunk

  /// The same for cells of this edge (m).
  [[nodiscard]] RefineOptions in_metres(float cell_m) const {
    return {.gate_m = gate_cells * cell_m,
            .last_gate_m = last_gate_cells * cell_m,
            .gate_decay = gate_decay,
            .max_iterations = max_iterations,
            .robust_m = robust_cells * cell_m,
            .stop_m = stop_m,
            .stop_rad = stop_rad};
  }
};

/// Settings of the refinements of one match. The gates and iterations of the coarse and the fine
/// level are from a prototype on 13 pairs of maps: 1.2 to 0.5 m in at most 12 iterations on cells
/// of 0.4 m, then 0.8 to 0.4 m on cells of 0.2 m.
struct RefinementConfig {
  std::size_t coarse_points = 2000;  ///< coarse surfels of b, at most; a prototype had 3000
  /// Without a prior, poses climb on few coarse surfels before they are ranked.
  RefinementStage climb{.gate_cells = 3.0F,
                        .last_gate_cells = 1.25F,
                        .gate_decay = 0.75F,
                        .max_iterations = 5,
                        .stop_m = 0.02,
                        .stop_rad = 2e-3};
  /// Each start begins with three iterations on the coarse surfels, ...
  RefinementStage begin{.gate_cells = 3.0F,
                        .last_gate_cells = 1.25F,
                        .gate_decay = 0.75F,
                        .max_iterations = 3,
                        .stop_m = 1e-3,
                        .stop_rad = 1e-4};
  /// ... and goes on with nine more, unless another start already goes the same way. This makes 60
  /// starts take the time of 40.
  RefinementStage coarse{.gate_cells = 1.3F,
                         .last_gate_cells = 1.25F,
                         .gate_decay = 0.75F,
                         .max_iterations = 9,
                         .stop_m = 1e-3,
                         .stop_rad = 1e-4};
  /// Two starts go the same way if they are nearer than this after `begin`: half of same_place().
  /// Chosen by hand, not tuned.
  double same_way_m = 0.4, same_way_rad = 0.04;
  /// Without a prior, the best few of the coarse level are refined and scored again on the fine
  /// surfels.
  std::size_t closer_looks = 6;  ///< chosen by hand, not tuned
  RefinementStage closer{.gate_cells = 4.0F,
                         .last_gate_cells = 2.0F,
                         .gate_decay = 0.7F,
                         .max_iterations = 6,
                         .stop_m = 1e-3,
                         .stop_rad = 1e-4};
  /// The result. The robust distance came in with the rule for terraces (see level()): errors in a
  /// forest fell from 0.08 to 0.03 m, in fr_079 from 0.022 to 0.012 m.
  RefinementStage fine{.gate_cells = 4.0F,
                       .last_gate_cells = 2.0F,
                       .gate_decay = 0.7F,
                       .max_iterations = 30,
                       .robust_cells = 0.4F,
                       .stop_m = 1e-4,
                       .stop_rad = 1e-5};
  /// Without a prior, a pose leans if it is off gravity by more than this many of anywhere()'s
  /// standard deviations: 12° after straightening. Refinement may lose gravity where one map has no floor. Chosen by
  /// hand, not tuned.
  double most_lean_sigmas = 7;
};

}  // namespace cairn::matching

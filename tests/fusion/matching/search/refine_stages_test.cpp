// SPDX-License-Identifier: Apache-2.0
#include "fusion/matching/search/refine_stages.hpp"

#include <gtest/gtest.h>

namespace cairn::matching {
namespace {

TEST(RefinementStage, LengthsAreInCellsAndNothingElseIs) {
  const RefinementStage stage{.gate_cells = 4,
                              .last_gate_cells = 2,
                              .gate_decay = 0.5F,
                              .max_iterations = 7,
                              .robust_cells = 0.25F,
                              .stop_m = 1e-3,
                              .stop_rad = 1e-4};
  const RefineOptions fine = stage.in_metres(0.5F);
  EXPECT_EQ(fine.gate_m, 2);
  EXPECT_EQ(fine.last_gate_m, 1);
  EXPECT_EQ(fine.robust_m, 0.125F);
  EXPECT_EQ(fine.gate_decay, stage.gate_decay);
  EXPECT_EQ(fine.max_iterations, stage.max_iterations);
  EXPECT_EQ(fine.stop_m, stage.stop_m);
  EXPECT_EQ(fine.stop_rad, stage.stop_rad);
}

}  // namespace
}  // namespace cairn::matching

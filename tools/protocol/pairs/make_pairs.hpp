// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/result.hpp"

namespace cairn::protocol {

struct PairsOptions {
  std::filesystem::path recordings;  ///< hallway/, lobby/ and office/ with robot_1 and robot_2; rgbd/robot_1
  std::filesystem::path octomaps;    ///< folder of .bt maps that are cut in halves; may be empty
  std::filesystem::path out;         ///< gets one folder for each pair
  unsigned seed = 1;
};

/// Makes every pair of maps of the protocol: the three scenes at the book's overlaps, the same from 45 % to 10 %,
/// halves of real OctoMaps, and a LiDAR's map that fills beside a depth camera's. Errors: those of the files.
[[nodiscard]] Result<void> make_pairs(const PairsOptions& options);

}  // namespace cairn::protocol

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "tools/protocol/pairs/json.hpp"
#include "tools/protocol/unlike/unlike_outcome.hpp"

namespace cairn::protocol {

/// unlike.json: `fusions[].{scene, fusion, seconds, voxels_a, voxels_b, overlap, error_m, error_deg, merge_s,
/// methods[].{method, rms_m, success, seconds, correspondences}}`, `entropies[].{scene, whole, shared, told}` with
/// `{ugv, uav, fused}` of each, `labels[]`, `claims[]`.
[[nodiscard]] Json unlike_json(const std::vector<UnlikeOutcome>& all, unsigned seed);
/// unlike.html: one page without anything from elsewhere.
[[nodiscard]] std::string unlike_page(const std::vector<UnlikeOutcome>& all, unsigned seed);

/// Writes both into `out`, and SCENE_fused.cairn of each scene. Prints the tables. Errors: those of load_unlike() and
/// the disk.
[[nodiscard]] Result<void> write_unlike(const std::filesystem::path& pairs, unsigned seed,
                                        const std::filesystem::path& out);

}  // namespace cairn::protocol

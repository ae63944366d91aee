// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "hal/result.hpp"
#include "tools/protocol/methods/outcome.hpp"
#include "tools/protocol/pairs/json.hpp"

namespace cairn::protocol {

/// protocol.json: `scenes[].{name, voxels_a, voxels_b, overlap, methods[].{method, success, mean_error_m,
/// mean_error_deg, seconds, iterations, …}, fused[]}`, `overlaps[]` and `heterogeneous[]` of the same form, `claims[]`.
[[nodiscard]] Json to_json(const Outcome& outcome);

/// protocol.html: one page without anything from elsewhere.
[[nodiscard]] std::string to_page(const Outcome& outcome);

/// Writes both into `out` and prints the tables. Errors: those of load_outcome() and the disk.
[[nodiscard]] Result<void> write_report(const std::filesystem::path& pairs, unsigned seed,
                                        const std::filesystem::path& out);

}  // namespace cairn::protocol

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tools/cli/doctor/finding.hpp"

namespace cairn::cli {

/// Devices that are plugged into this computer, and what keeps it from real time. `root` is `/`, or a folder like it
/// with proc, sys and dev.
[[nodiscard]] Findings examine_cameras(const std::filesystem::path& root);
[[nodiscard]] Findings examine_can(const std::filesystem::path& root);
[[nodiscard]] Findings examine_gpio(const std::filesystem::path& root);
/// Kernel, processor governor, locked memory, real-time priority, receive buffers.
[[nodiscard]] Findings examine_real_time(const std::filesystem::path& root);

}  // namespace cairn::cli

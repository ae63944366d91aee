// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "onboard/perception/networks/config/network_config.hpp"
#include "tools/cli/doctor/finding.hpp"

namespace cairn::cli {

/// Opens each network of a profile, runs it on a black picture, and compares its time with its rate. `profile`: the
/// file, for relative paths.
[[nodiscard]] Findings examine_networks(const networks::PerceptionConfig& config, const std::filesystem::path& profile);

}  // namespace cairn::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "hal/time.hpp"
#include "tools/cli/doctor/finding.hpp"

namespace cairn::cli {

/// Reads the profile, opens each of its devices and listens to it for `listen`, and tries its networks.
[[nodiscard]] Findings examine_profile(const std::filesystem::path& profile, Duration listen);
/// Takes the whole recording through its decoders: damage, losses, silence.
[[nodiscard]] Findings examine_recording(const std::filesystem::path& folder);

}  // namespace cairn::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"
#include "tools/simulator/scenes/make_world.hpp"
#include "tools/simulator/world/world.hpp"

namespace cairn::simulator {

/// The names that make_world knows.
[[nodiscard]] const std::vector<std::string>& scene_names();

/// Errc::kNotFound, with the known names in `detail`, for any other name.
[[nodiscard]] Result<World> make_world(std::string_view name);

}  // namespace cairn::simulator

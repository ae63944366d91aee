// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/result.hpp"
#include "tools/simulator/simulate.hpp"

namespace CLI {
class App;
}

namespace cairn::cli {

/// Options that were given and would change no recording, because what they are of is not simulated: a sensor, people
/// or a husky. Error kInvalidConfig names one and the remedy. `config` is what `sub`, `cairn simulate`, was parsed
/// into.
[[nodiscard]] Result<void> check_unused_options(const CLI::App& sub, const simulator::SimulationConfig& config);

}  // namespace cairn::cli

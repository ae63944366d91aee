// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hal/time.hpp"
#include "tools/team/network/radio.hpp"

namespace cairn::team_run {

struct Kill {
  Duration after{};  ///< of the run's start
  Index robot = 0;
};

/// A plan that kills each robot's peer process `times` times. `span` is cut into as many equal parts, and there is one
/// kill somewhere in each. Kills are in order of time. The same seed gives the same plan.
[[nodiscard]] std::vector<Kill> plan_kills(std::uint64_t seed, Index robots, std::size_t times, Duration span);

}  // namespace cairn::team_run

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hal/time.hpp"
#include "tools/team/network/radio.hpp"

namespace cairn::team {

struct Kill {
  Duration after{};  ///< of the run's start
  Index robot = 0;
};

/// Each robot's peer process `times` times, spread over `span`: one somewhere in each of as many equal parts of it.
/// In order of time. Same seed, same plan.
[[nodiscard]] std::vector<Kill> plan_kills(std::uint64_t seed, Index robots, std::size_t times, Duration span);

}  // namespace cairn::team

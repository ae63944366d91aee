// SPDX-License-Identifier: Apache-2.0
#include "tools/team/kill_plan.hpp"

#include <algorithm>
#include <random>
#include <tuple>

namespace cairn::team_run {

std::vector<Kill> plan_kills(std::uint64_t seed, Index robots, std::size_t times, Duration span) {
  std::mt19937_64 random(seed);
  std::vector<Kill> plan;
  for (Index robot = 0; robot < robots; ++robot)
    for (std::size_t i = 0; i < times; ++i) {
      // By hand: the standard's distributions differ between libraries.
      const double share = static_cast<double>(random() >> 11U) * 0x1p-53;
      plan.push_back(
          {from_seconds((static_cast<double>(i) + share) / static_cast<double>(times) * to_seconds(span)), robot});
    }
  std::ranges::sort(plan, {}, [](const Kill& kill) { return std::tuple(kill.after, kill.robot); });
  return plan;
}

}  // namespace cairn::team_run

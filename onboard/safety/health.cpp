// SPDX-License-Identifier: Apache-2.0
#include "onboard/safety/health.hpp"

#include <algorithm>

namespace cairn::safety {
namespace {

// A supervisor that was away for so long cannot tell a hung task from a machine that stood.
constexpr Duration kAway = std::chrono::milliseconds(500);

}  // namespace

Supervisor::Supervisor(std::vector<Pulse> pulses) : pulses_(std::move(pulses)), last_(pulses_.size()) {}

std::optional<Supervisor::Finding> Supervisor::step(Time now) {
  const bool anew = !stepped_ || now - *stepped_ > kAway || now < *stepped_;
  stepped_ = now;
  std::optional<Finding> worst;
  Duration most = Duration::zero();
  for (std::size_t i = 0; i < pulses_.size(); ++i) {
    const std::uint64_t beats = pulses_[i].beats->get();
    if (anew || beats != last_[i].beats) last_[i] = {beats, now};
    const Duration silent = now - last_[i].at;
    if (silent - pulses_[i].limit <= most) continue;
    most = silent - pulses_[i].limit;
    worst = Finding{i, silent};
  }
  return worst;
}

}  // namespace cairn::safety

// SPDX-License-Identifier: Apache-2.0
#include "onboard/app/team/team_profile.hpp"

#include <random>

namespace cairn {

void declare(config::Section& s, TeamProfile& p) {
  s.integer("id", p.id, {0, 65535}, "", "the robot's number in its team, its own there; 0: it is in none");
  s.text("socket", p.socket, "local socket that it shares with its peer process (cairn-peers --socket)");
  s.integer("bytes_per_second", p.bytes_per_second, {1000, 10'000'000}, "B/s",
            "what it tells others, all overhead included; cairn-peers has a cap of its own below");
  s.number("match_s", p.match_s, {0.1, 60}, "s", "one comparison of two maps may take so long; it holds up nothing");
}

TeamConfig team_config(const TeamProfile& profile, peers::RobotId id, const std::string& name, double resolution_m) {
  TeamConfig config;
  config.id = id;
  config.name = name;
  config.resolution_m = resolution_m;
  config.exchange.bytes_per_second = static_cast<std::size_t>(profile.bytes_per_second);
  return config;
}

peers::Epoch new_epoch(Time now_utc) {
  const auto seconds = static_cast<peers::Epoch>(to_seconds(now_utc));
  return seconds << kRandomBits | std::random_device{}() >> (32U - kRandomBits);
}

}  // namespace cairn

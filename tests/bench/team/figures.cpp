// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/team/figures.hpp"

#include <algorithm>
#include <cstdio>

namespace cairn::bench {

using peers::RobotId;
using peers::Version;

void SentBytes::add(std::span<const std::byte> datagram, std::size_t copies) {
  Kind& kind = kinds_.at(std::to_integer<std::size_t>(datagram[1]));
  kind.datagrams += copies;
  kind.bytes += copies * (datagram.size() + kOverhead);
}

std::uint64_t SentBytes::all() const {
  std::uint64_t sum = 0;
  for (const Kind& kind : kinds_) sum += kind.bytes;
  return sum;
}

void SentBytes::print() const {
  const auto named = [](std::size_t parts) {
    std::string name = (parts & peers::kHelloPart) != 0 ? " hello" : "";
    name += (parts & peers::kDigestPart) != 0 ? " digest" : "";
    return name + ((parts & peers::kItemsPart) != 0 ? " items" : "");
  };
  std::printf("  sent");
  for (std::size_t parts = 1; parts < kinds_.size(); ++parts)
    if (const Kind& kind = kinds_.at(parts); kind.datagrams > 0)
      std::printf(" [%s ] %.1f kB in %llu", named(parts).c_str(), static_cast<double>(kind.bytes) / 1e3,
                  static_cast<unsigned long long>(kind.datagrams));
  std::puts("");
}

void Ages::said(const team::Team& team, Time now) {
  auto& times = said_[team.exchange().self()];
  times.resize(
      std::max<std::size_t>(times.size(), team.exchange().layers().at(team.exchange().self()).holding.newest()), now);
}

void Ages::fused(const team::Team& team, Time now) {
  const RobotId self = team.exchange().self();
  for (const auto& entry : said_) {
    const RobotId robot = entry.first;
    const auto& times = entry.second;
    if (robot == self) continue;
    const Way way{robot, self};
    Version& looked_at = looked_at_[way];
    auto& waits = waits_[way];
    const bool merged =
        std::ranges::any_of(team.map().poses(), [&](const auto& pose) { return pose.first.robot == robot; });
    for (; looked_at < times.size(); ++looked_at)
      if (merged) waits.push_back(looked_at + 1);
    const auto layer = team.exchange().layers().find(robot);
    if (!team.map().shows_newest_tiles() || layer == team.exchange().layers().end()) continue;
    std::erase_if(waits, [&](Version version) {
      if (!layer->second.holding.known().contains(version)) return false;
      ages_.push_back({times[version - 1], to_seconds(now - times[version - 1])});
      return true;
    });
  }
}

double Ages::quantile(double q, Time until) const {
  std::vector<double> sorted;
  for (const auto& [said, age] : ages_)
    if (said <= until) sorted.push_back(age);
  std::ranges::sort(sorted);
  return sorted.empty() ? 0 : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

void print_items(const team::Team& team) {
  std::uint64_t sent = 0, received = 0, known = 0;
  for (const auto& [id, link] : team.exchange().links()) {
    sent += link.sent_items;
    received += link.received_items;
    known += link.repeated_items;
  }
  std::printf("  items: sent %llu, received %llu, of these known before %llu\n", static_cast<unsigned long long>(sent),
              static_cast<unsigned long long>(received), static_cast<unsigned long long>(known));
}

}  // namespace cairn::bench

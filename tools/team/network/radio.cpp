// SPDX-License-Identifier: Apache-2.0
#include "tools/team/network/radio.hpp"

#include <algorithm>

namespace cairn::team_run {
namespace {

/// SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014): mixes one word.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// Evenly in [0, 1).
double unit(std::uint64_t x) { return static_cast<double>(mixed(x) >> 11U) * 0x1p-53; }

}  // namespace

Fate fate_of(const LinkConfig& link, Index from, Index to, std::uint64_t n) {
  std::uint64_t key = static_cast<std::uint64_t>(link.seed);
  for (const std::uint64_t word : {std::uint64_t{from}, std::uint64_t{to}, n}) key = mixed(key ^ word);
  const auto delay = [&](std::uint64_t draw) {
    if (unit(key + draw) < link.reorder) return Duration{};
    const double ms = link.delay_ms + link.jitter_ms * (2 * unit(key + draw + 1) - 1);
    return from_seconds(std::max(0.0, ms) / 1000);
  };
  return {unit(key) < link.loss, unit(key + 1) < link.duplicate, {delay(2), delay(4)}};
}

void Radio::offer(Index from, Index to, std::span<const std::byte> bytes, Time now) {
  Sender& sender = senders_[from];
  Counters& counted = sender.counters;
  ++counted.tx_packets;
  counted.tx_bytes += bytes.size();
  const std::uint64_t n = sender.packets[to]++;
  sender.free = std::max(sender.free, now);
  if (to_milliseconds(sender.free - now) > link_.queue_ms) {
    ++counted.queue_full;
    return;
  }
  if (link_.rate_bit_s > 0) sender.free += from_seconds(8 * static_cast<double>(bytes.size()) / link_.rate_bit_s);
  const Fate fate = fate_of(link_, from, to, n);
  if (fate.lost) {
    ++counted.lost;
    return;
  }
  const Packet packet{from, to, {bytes.begin(), bytes.end()}};
  if (fate.twice) {
    ++counted.doubled;
    on_the_way_.emplace(sender.free + fate.delay[1], packet);
  }
  on_the_way_.emplace(sender.free + fate.delay[0], packet);
}

std::optional<Time> Radio::next() const {
  if (on_the_way_.empty()) return std::nullopt;
  return on_the_way_.begin()->first;
}

void Radio::arrived(Time now, std::vector<Packet>& out) {
  const auto end = on_the_way_.upper_bound(now);
  for (auto it = on_the_way_.begin(); it != end; ++it) {
    Counters& counted = senders_[it->second.to].counters;
    ++counted.rx_packets;
    counted.rx_bytes += it->second.bytes.size();
    most_late_ = std::max(most_late_, now - it->first);
    out.push_back(std::move(it->second));
  }
  on_the_way_.erase(on_the_way_.begin(), end);
}

}  // namespace cairn::team_run

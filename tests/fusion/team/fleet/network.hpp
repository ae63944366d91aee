// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "fusion/peers/exchange.hpp"
#include "hal/time.hpp"

namespace cairn::fleet {

using peers::RobotId;

/// What a link does to datagrams.
struct LinkQuality {
  double loss = 0, duplicates = 0;
  double replays = 0;  ///< datagrams that come again up to a minute later
  Duration delay = std::chrono::milliseconds(5), jitter{};
};

/// Datagrams between robots in virtual time; the same seed, the same fate of each. Jitter reorders.
class Network {
 public:
  struct Delivery {
    RobotId from = 0, to = 0;
    std::vector<std::byte> bytes;
  };

  Network(const LinkQuality& quality, unsigned seed) : quality_(quality), random_(seed) {}

  /// Robots of different sides do not reach each other; all are of side 0 until they are put elsewhere.
  void put(RobotId robot, int side) { side_[robot] = side; }
  /// These two do not reach each other, whatever their sides.
  void cut(RobotId a, RobotId b) { cut_.insert({std::min(a, b), std::max(a, b)}); }
  /// Nobody hears this one, which hears everybody.
  void mute(RobotId robot, bool muted) { muted ? void(muted_.insert(robot)) : void(muted_.erase(robot)); }
  void set_quality(const LinkQuality& quality) { quality_ = quality; }

  void send(const Delivery& datagram, Time now) {
    ++sent_;
    if (!reaches(datagram.from, datagram.to) || chance(quality_.loss)) return;
    on_the_way_.emplace(now + quality_.delay + part_of(quality_.jitter), datagram);
    if (chance(quality_.duplicates)) on_the_way_.emplace(now + quality_.delay + part_of(quality_.jitter), datagram);
    if (chance(quality_.replays)) on_the_way_.emplace(now + part_of(std::chrono::seconds(60)), datagram);
  }
  /// To whom it is for, of robots 1 … `robots`; says how many that were.
  std::size_t send(RobotId from, RobotId robots, const peers::Outgoing& datagram, Time now) {
    std::size_t copies = 0;
    for (RobotId id = 1; id <= robots; ++id) {
      if (id == from || (datagram.to != 0 && datagram.to != id)) continue;
      send({from, id, datagram.bytes}, now);
      ++copies;
    }
    return copies;
  }
  /// What arrives until `now`, in order.
  [[nodiscard]] std::vector<Delivery> arrived(Time now) {
    std::vector<Delivery> arrived;
    const auto end = on_the_way_.upper_bound(now);
    for (auto it = on_the_way_.begin(); it != end; ++it) arrived.push_back(std::move(it->second));
    on_the_way_.erase(on_the_way_.begin(), end);
    return arrived;
  }
  [[nodiscard]] std::size_t sent() const { return sent_; }

 private:
  bool reaches(RobotId a, RobotId b) {
    return side_[a] == side_[b] && !muted_.contains(a) && !cut_.contains({std::min(a, b), std::max(a, b)});
  }
  bool chance(double p) { return std::uniform_real_distribution<>(0, 1)(random_) < p; }
  Duration part_of(Duration most) {
    return Duration{std::uniform_int_distribution<std::int64_t>(0, most.count())(random_)};
  }

  LinkQuality quality_;
  std::mt19937 random_;
  std::set<RobotId> muted_;
  std::map<RobotId, int> side_;
  std::set<std::pair<RobotId, RobotId>> cut_;
  std::multimap<Time, Delivery> on_the_way_;
  std::size_t sent_ = 0;
};

}  // namespace cairn::fleet

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fusion/peers/exchange.hpp"
#include "fusion/peers/tile_codec.hpp"
#include "tests/fusion/fleet/network.hpp"
#include "tests/fusion/peers/tile_states.hpp"

namespace cairn::fleet {

using peers::Exchange;
using peers::ItemId;

/// Robots that run the real exchange in one thread, with a virtual clock and network.
class Fleet {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds(200);

  Fleet(unsigned robots, std::size_t bytes_per_second, const LinkQuality& quality, unsigned seed)
      : network(quality, seed), bytes_per_second_(bytes_per_second), random_(seed ^ 0x5EEDU) {
    for (RobotId id = 1; id <= robots; ++id) start(id, 1);
  }

  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] Exchange& robot(RobotId id) { return *robots_.at(id).exchange; }
  [[nodiscard]] bool up(RobotId id) const { return robots_.at(id).exchange != nullptr; }
  [[nodiscard]] std::size_t refused() const { return refused_; }

  /// A robot begins for the nth time, as far as it remembers, knowing nothing.
  void start(RobotId id, std::uint64_t nth) {
    const peers::Epoch epoch = nth << 32U | (random_() & 0xFFFFFFFFU);
    peers::ExchangeConfig config;
    config.bytes_per_second = bytes_per_second_;
    robots_[id].exchange = std::make_unique<Exchange>(id, "robot_" + std::to_string(id), epoch, config);
  }
  void crash(RobotId id) { robots_.at(id).exchange.reset(); }

  /// A robot sees something: some tiles change, many of them again.
  void observe(RobotId id, int tiles) {
    if (!up(id)) return;
    for (int i = 0; i < tiles; ++i) {
      std::vector<std::byte> payload;
      peers::encode_tile(peers::wall_tile_state(random_), payload);
      robot(id).say(ItemId::tile(0, {random_() % 120}), payload);
    }
  }

  void step() {
    now_ += kTick;
    for (auto& arrived : network.arrived(now_))
      if (up(arrived.to) && !robot(arrived.to).receive(arrived.bytes, clock(arrived.to))) ++refused_;
    for (auto& [id, robot] : robots_) {
      if (!robot.exchange) continue;
      send(id, robot);
    }
  }
  void run_until(Time end) {
    while (now_ < end) step();
  }

  /// Whether every robot that is up knows all that every one of them has said.
  [[nodiscard]] bool agrees() const {
    for (const auto& [id, origin] : robots_)
      for (const auto& [other, robot] : robots_)
        if (id != other && origin.exchange && robot.exchange && !knows_all(*robot.exchange, *origin.exchange))
          return false;
    return true;
  }

  Network network;

 private:
  struct Robot {
    std::unique_ptr<Exchange> exchange;
  };

  /// Clocks of different robots have nothing in common, and drift.
  [[nodiscard]] Time clock(RobotId id) const {
    const auto elapsed = now_.time_since_epoch();
    const auto drift = elapsed / 1'000'000 * (static_cast<std::int64_t>(id % 3) - 1) * 50;
    return now_ + drift + std::chrono::seconds(2) * static_cast<std::int64_t>(id % 2) + std::chrono::hours(id);
  }

  void send(RobotId id, Robot& robot) {
    out_.clear();
    robot.exchange->send(clock(id), out_);
    for (const peers::Outgoing& datagram : out_) network.send(id, robots_.size(), datagram, now_);
  }

  static bool knows_all(const Exchange& robot, const Exchange& origin) {
    const auto layer = robot.layers().find(origin.self());
    const auto& own = origin.layers().at(origin.self());
    if (layer == robot.layers().end()) return own.holding.items().empty();
    const auto &held = layer->second.holding.items(), &said = own.holding.items();
    return layer->second.epoch == own.epoch && held.size() == said.size() &&
           std::equal(said.begin(), said.end(), held.begin(), [](const auto& a, const auto& b) {
             return a.first == b.first && a.second.version == b.second.version && a.second.payload == b.second.payload;
           });
  }

  Time now_{};
  std::size_t bytes_per_second_;
  std::mt19937 random_;
  std::map<RobotId, Robot> robots_;
  std::vector<peers::Outgoing> out_;
  std::size_t refused_ = 0;
};

}  // namespace cairn::fleet

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "drivers/peers/local_link.hpp"
#include "fusion/peers/exchange.hpp"
#include "fusion/peers/items/claim.hpp"
#include "fusion/peers/items/tile_codec.hpp"
#include "hal/clock.hpp"

namespace cairn::app {

inline constexpr std::size_t kLeastTiles = 50;  ///< of the robot's map, before its peer knows it

inline mapping::TileKey tile_at(double x, double y, double z, double resolution_m) {
  const auto voxel = [&](double v) { return static_cast<std::uint16_t>(32768 + std::floor(v / resolution_m)); };
  return mapping::TileKey::of_voxel(voxel(x), voxel(y), voxel(z));
}

/// A peer that knows one pillar, far from anything that the robot sees, and where the two are.
class PillarPeer {
 public:
  explicit PillarPeer(std::filesystem::path socket)
      : socket_(std::move(socket)), link_(peer_link::LocalLink::connect(socket_)) {
    mapping::TileState pillar;
    for (unsigned z = 0; z < 8; ++z) pillar.set(3, 4, z, 3.5F);
    std::vector<std::byte> bytes;
    peers::encode_tile(pillar, bytes);
    exchange_.say(peers::ItemId::tile(0, tile_at(60, 60, 1, 0.1)), bytes);
  }

  /// Until `over` says true; the peer process between the two dies and comes back, with every third word.
  void speak(const std::function<bool()>& over) {
    const LiveClock clock;
    for (int i = 0; !over(); ++i) {
      LiveClock::wait_until(clock.now() + kTick);
      hear(clock.now());
      knows_the_map_ = known_items() > kLeastTiles;
      if (i % 3 == 0) {
        link_.emplace(peer_link::LocalLink::connect(socket_));
        ++deaths_;
      }
      (void)link_->join();
      say_where_the_robot_is();
      std::vector<peers::Outgoing> out;
      exchange_.send(clock.now(), out);
      for (const auto& datagram : out) link_->send({peer_link::LinkFrame::Kind::kReceived, 2, datagram.bytes});
    }
  }
  /// The robot's map. May be asked while speak() goes on.
  [[nodiscard]] bool knows_the_map() const { return knows_the_map_; }
  /// Of the peer process. May be asked while speak() goes on.
  [[nodiscard]] int deaths() const { return deaths_; }

 private:
  static constexpr Duration kTick = std::chrono::milliseconds(40);

  void hear(Time now) {
    if (!link_->join()) return;
    peer_link::LinkFrame frame;
    while (link_->receive(memory_, frame)) (void)exchange_.receive(frame.bytes, now);
  }
  [[nodiscard]] std::size_t known_items() const {
    const auto robot = exchange_.layers().find(1);
    return robot == exchange_.layers().end() ? 0 : robot->second.holding.items().size();
  }
  void say_where_the_robot_is() {
    const auto robot = exchange_.links().find(1);
    if (robot == exchange_.links().end()) return;
    UncertainPose pose;
    pose.covariance = 1e-4 * Matrix6::Identity();
    const peers::Edge edge{0, 1, robot->second.epoch, 0, pose, 0.99F};
    exchange_.say(peers::ItemId::edge(0), encode(edge));
  }

  std::filesystem::path socket_;
  std::optional<peer_link::LocalLink> link_;
  peers::Exchange exchange_{2, "second", std::uint64_t{7} << 32U, {.voxel_um = 100'000}};
  std::vector<std::byte> memory_;
  std::atomic<bool> knows_the_map_ = false;
  std::atomic<int> deaths_ = 0;
};

}  // namespace cairn::app

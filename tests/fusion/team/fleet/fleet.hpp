// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fusion/team/team.hpp"
#include "tests/fusion/peers/tile_states.hpp"
#include "tests/fusion/team/fleet/network.hpp"

namespace cairn::fleet {

using peers::Exchange;

/// Robots that run a real team in one thread, with a virtual clock and network. They know where the others are, by
/// claims, and so hold one map. They drive as they observe, from submap to submap, and every comparison of two submaps
/// finds that they have drifted a little.
class Fleet {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds(200), kComparisons = std::chrono::seconds(10);

  Fleet(unsigned robots, std::size_t bytes_per_second, const LinkQuality& quality, unsigned seed)
      : network(quality, seed), bytes_per_second_(bytes_per_second), random_(seed ^ 0x5EEDU) {
    for (RobotId id = 1; id <= robots; ++id) start(id, 1);
  }

  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] const Exchange& robot(RobotId id) const { return robots_.at(id)->exchange(); }
  [[nodiscard]] const team::Team& team(RobotId id) const { return *robots_.at(id); }
  [[nodiscard]] bool hears(RobotId id, RobotId other) const { return robot(id).hears(other, clock(id)); }
  [[nodiscard]] bool up(RobotId id) const { return robots_.at(id) != nullptr; }
  [[nodiscard]] std::size_t refused() const { return refused_; }

  /// A robot begins for the nth time, as far as it remembers, knowing nothing.
  void start(RobotId id, std::uint64_t nth) {
    const peers::Epoch epoch = nth << 32U | (random_() & 0xFFFFFFFFU);
    team::TeamConfig config;
    config.id = id;
    config.name = "robot_" + std::to_string(id);
    config.exchange.bytes_per_second = bytes_per_second_;
    config.own_submaps.length_m = 120;
    robots_[id] = std::make_unique<team::Team>(config, epoch);
    for (const RobotId other : {id - 1, id + 1})
      if (other > 0) robots_[id]->claim(other, T_of(id, other), 0.99);
  }
  void crash(RobotId id) { robots_.at(id).reset(); }

  /// A robot sees something: some tiles change, many of them again.
  void observe(RobotId id, int tiles) {
    if (!up(id)) return;
    path_m_[id] += 1;
    robots_.at(id)->be_at({SE3(Eigen::Quaterniond::Identity(), {path_m_[id], 0, 0}), Matrix6::Zero()});
    for (int i = 0; i < tiles; ++i) {
      const auto at = [&](unsigned most) { return static_cast<std::uint16_t>(32768 + 8 * (random_() % most)); };
      const auto z = at(4), y = at(6), x = at(5);  // of arguments, each compiler draws another first
      robots_.at(id)->observe(mapping::TileKey::of_voxel(x, y, z), peers::wall_tile_state(random_), clock(id));
    }
  }
  /// How many tiles a robot fuses, and how often.
  void set_slice(int tiles, Duration every) {
    slice_ = tiles;
    every_ = every;
  }

  void step() {
    now_ += kTick;
    for (auto& arrived : network.arrived(now_))
      if (up(arrived.to) && !robots_.at(arrived.to)->receive(arrived.bytes, clock(arrived.to))) ++refused_;
    for (auto& [id, robot] : robots_)
      if (robot) step(id, *robot);
  }
  void run_until(Time end) {
    while (now_ < end) step();
  }

  /// Whether all was said, every robot that is up knows all that every one of them has said, and all their maps are of
  /// one piece.
  [[nodiscard]] bool agrees() const {
    for (const auto& [id, origin] : robots_)
      for (const auto& [other, robot] : robots_)
        if (id != other && origin && robot && !knows_all(robot->exchange(), origin->exchange())) return false;
    for (const auto& [id, robot] : robots_)
      if (robot && (robot->unsaid() > 0 || !robot->map().up_to_date())) return false;
    return true;
  }

  /// The team's map of each robot that is up, to the byte.
  [[nodiscard]] std::set<std::string> maps() const {
    std::set<std::string> maps;
    for (const auto& [id, robot] : robots_) {
      if (!robot) continue;
      std::ostringstream bytes;
      mapping::SemanticOcTree copy(robot->map().map());
      (void)copy.writeData(bytes);
      maps.insert(bytes.str());
    }
    return maps;
  }

  Network network;

 private:
  /// Along a bent line, some voxels and some degrees apart.
  static UncertainPose T_of(RobotId id, RobotId other) {
    const auto place = [](RobotId robot) {
      const auto n = static_cast<double>(robot);
      return SE3::from_xyz_rpy((Vector6() << 0.7 * n, 0.05 * n * n, 0.02 * n, 0, 0, 0.3 * n).finished());
    };
    UncertainPose pose;
    pose.mean = place(id).inverse() * place(other);
    pose.covariance = 1e-4 * Matrix6::Identity();
    return pose;
  }

  /// Clocks of different robots have nothing in common, and drift.
  [[nodiscard]] Time clock(RobotId id) const {
    const auto elapsed = now_.time_since_epoch();
    const auto drift = elapsed / 1'000'000 * (static_cast<std::int64_t>(id % 3) - 1) * 50;
    return now_ + drift + std::chrono::seconds(2) * static_cast<std::int64_t>(id % 2) + std::chrono::hours(id);
  }

  void step(RobotId id, team::Team& robot) {
    out_.clear();
    robot.step(clock(id), out_);
    for (const peers::Outgoing& datagram : out_) network.send(id, robots_.size(), datagram, now_);
    if (now_.time_since_epoch() % kComparisons < kTick) compare(robot, clock(id));
    if (now_.time_since_epoch() % every_ >= kTick) return;
    Budget budget = Budget::steps(slice_);
    (void)robot.fuse(budget);
  }

  void compare(team::Team& robot, Time now) {
    auto job = robot.next_match(now);
    if (!job) return;
    if (job->refinement) {
      const double drift = std::uniform_real_distribution<>(-0.2, 0.2)(random_);
      UncertainPose& found = job->refinement->found.emplace();
      found.mean = job->refinement->guess.mean * SE3(Eigen::Quaterniond::Identity(), {drift, -drift, 0});
      found.covariance = 1e-4 * Matrix6::Identity();
      job->refinement->probability = 0.97;
    }
    robot.matched(std::move(*job), now);
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
  std::map<RobotId, std::unique_ptr<team::Team>> robots_;
  int slice_ = 1;
  Duration every_ = std::chrono::seconds(1);  // little, while nobody asks: a test runs thousands of minutes
  std::vector<peers::Outgoing> out_;
  std::map<RobotId, double> path_m_;
  std::size_t refused_ = 0;
};

}  // namespace cairn::fleet

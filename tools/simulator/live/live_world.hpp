// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "tools/simulator/live/driven_body.hpp"
#include "tools/simulator/live/lidar_player.hpp"
#include "tools/simulator/live/motors.hpp"
#include "tools/simulator/live/recent_track.hpp"

namespace cairn::simulator {

/// A robot in a world that plays in real time: its motors obey a CAN bus, its wheels move it over the ground, and its
/// LiDAR sees the world from where it is. Time is the clock's alone, so it can be a virtual one.
class LiveWorld {
 public:
  /// What the world stands on; all of it must outlive the world.
  struct Scene {
    const World& world;
    const FloorPlan& plan;
    const Tracer& tracer;
  };
  /// How the world meets everything else.
  struct Ports {
    drive::CanLink& bus;
    LidarPlayer::Wire wire;
    /// Gets T_world_base as x y z roll pitch yaw, a hundred times a second.
    std::function<void(Time, const Vector6&)> truth;
    /// Gets what a person should know, in words.
    std::function<void(const std::string&)> say;
  };
  struct Config {
    GroundPose start;
    LidarConfig lidar;
    WheelConfig wheels;
    drive::Config drive;            ///< as its owner has measured it
    std::uint64_t seed = 1;         ///< of wheels, noise and the LiDAR's clock
    std::int64_t start_utc_ns = 0;  ///< wall time now
  };
  static constexpr Duration kTruthEvery = std::chrono::milliseconds(10);
  static constexpr Duration kFaultAgain = std::chrono::seconds(10);  ///< until a fault that lasts is said again
  static constexpr int kMostFrames = 256;  ///< of the bus in one play(), so that a babbling program cannot hold it

  /// Time begins now, at rest, with the motors' power coming on. `clock` must outlive it.
  LiveWorld(const Scene& scene, const Config& config, Ports ports, const Clock& clock);
  LiveWorld(const LiveWorld&) = delete;
  LiveWorld& operator=(const LiveWorld&) = delete;
  ~LiveWorld() = default;

  /// Brings the world up to the clock's time. Sends one packet at most, so that the bus is heard in between.
  void play();
  /// Sends all packets that are due at the world's time.
  void send_rest();
  /// When play() has something to do again.
  [[nodiscard]] Time next_due() const;

  [[nodiscard]] Time start() const { return track_.start(); }
  [[nodiscard]] Time now() const { return track_.end(); }
  [[nodiscard]] const DrivenBody& body() const { return body_; }
  [[nodiscard]] const Motors& motors() const { return motors_; }
  [[nodiscard]] const LidarPlayer& lidar() const { return player_; }

 private:
  void obey_bus();
  void send_one();
  void move_until(Time t);
  void move();
  void say_contacts();
  void say_fault(const char* where, const Error& error);

  Ports ports_;
  const Clock& clock_;
  DrivenBody body_;
  RecentTrack track_;
  Motors motors_;
  Lidar lidar_;
  LidarPlayer player_;
  Packet packet_;
  int contacts_said_ = 0;
  std::string fault_;  // the last that was said
  Time fault_said_{};
};

/// Plays the world until `ended`; a world that is late then sends what is due. `wait_until` waits on the world's clock.
void play(LiveWorld& world, const std::function<void(Time)>& wait_until, const std::function<bool()>& ended);

}  // namespace cairn::simulator
